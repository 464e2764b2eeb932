// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/tracker_link.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/simulator/mixed_bits.hpp"

namespace handeye::simulator {
namespace {

/// Distinguish the drawings.
constexpr std::uint64_t kLosses = 0x6c6f7374;
constexpr std::uint64_t kOvertaken = 0x6f766572;
constexpr std::uint64_t kTwice = 0x74776f;
constexpr std::uint64_t kBurst = 0x6275727374;

/// One burst in so many seconds.
constexpr double kBurstPeriod_s = 2.0;

/// A twin follows so much later; a burst empties at this pace.
constexpr std::int64_t kTwinNs = 50'000;
constexpr std::int64_t kWithinBurstNs = 20'000;

/// One that is overtaken is late by so many sampling periods: the next passes, the one after not.
constexpr double kOvertakenPeriods = 1.4;

}  // namespace

TrackerLink::TrackerLink(const World& world) : world_(&world), device_(world) {}

void TrackerLink::next(SimulatedDatagram& datagram) {
  const auto later = [](const Pending& a, const Pending& b) { return a.later_than(b); };
  // Nothing arrives earlier than it was sent to: what is due before the last one sent is next.
  while (pending_.empty() || pending_.front().arrival_ns > sent_until_ns_) send();
  std::ranges::pop_heap(pending_, later);
  std::swap(datagram, pending_.back().datagram);
  datagram.arrival_ns = pending_.back().arrival_ns;
  pending_.pop_back();
}

void TrackerLink::send() {
  device_.next(sent_);
  sent_until_ns_ = sent_.arrival_ns;
  const std::uint64_t seed = world_->options.seed;
  const std::uint64_t number = count_++;
  const auto happens = [&](FaultKind kind, std::uint64_t drawing) {
    return mixed_fraction(seed ^ drawing, number) < share_of(world_->tracker_faults, kind);
  };
  if (happens(FaultKind::kLost, kLosses)) return;
  std::int64_t arrival_ns = sent_.arrival_ns;
  if (happens(FaultKind::kReordered, kOvertaken)) {
    arrival_ns += std::llround(1e9 * kOvertakenPeriods / world_->options.tracker_rate_hz);
  }
  arrival_ns = held_until_ns(arrival_ns);
  deliver(arrival_ns);
  if (happens(FaultKind::kDuplicated, kTwice)) deliver(arrival_ns + kTwinNs);
}

void TrackerLink::deliver(std::int64_t arrival_ns) {
  pending_.push_back({arrival_ns, order_++, sent_});
  std::ranges::push_heap(pending_,
                         [](const Pending& a, const Pending& b) { return a.later_than(b); });
}

std::int64_t TrackerLink::held_until_ns(std::int64_t arrival_ns) const {
  const double hold_s = share_of(world_->tracker_faults, FaultKind::kBursts);
  if (hold_s <= 0) return arrival_ns;
  const double arrival_s = 1e-9 * static_cast<double>(arrival_ns - world_->start_ns);
  const double period = std::floor(arrival_s / kBurstPeriod_s);
  const double begin_s =
      kBurstPeriod_s * period +
      (kBurstPeriod_s - hold_s) *
          mixed_fraction(world_->options.seed ^ kBurst, static_cast<std::uint64_t>(period));
  if (arrival_s < begin_s || arrival_s >= begin_s + hold_s) return arrival_ns;
  // In the order in which they would have come, one hard upon the other.
  const double place = (arrival_s - begin_s) * world_->options.tracker_rate_hz;
  return world_->host_ns(begin_s + hold_s) + std::llround(place * kWithinBurstNs);
}

}  // namespace handeye::simulator
