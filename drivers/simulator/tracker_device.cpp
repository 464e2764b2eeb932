// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/tracker_device.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/dtrack/formatter.hpp"

namespace handeye::simulator {
namespace {

constexpr double kLargestJitterS = 0.008;
constexpr std::int64_t kClosestArrivalsNs = 20'000;

/// The day on which every simulation begins, 2026-01-15, in days since 1970.
constexpr std::int64_t kDayOfUnixTime = 20'468;

}  // namespace

TrackerDevice::TrackerDevice(const World& world)
    : world_(&world),
      noise_(world.options.seed, Purpose::kTrackerNoise),
      sight_(world.options.seed, rad_from_deg(world.options.tracker_noise_deg),
             world.options.tracker_noise_mm),
      arrivals_(world.options.seed, Purpose::kArrivals),
      phase_(arrivals_.uniform(0.0, 1.0)),
      first_number_(static_cast<std::uint32_t>(arrivals_.uniform(1.0, 100'000.0))),
      last_arrival_ns_(world.start_ns) {
  frame_.calibrated_bodies = world.options.body_id + 1;
  frame_.bodies.resize(1);
  frame_.bodies.front().id = world.options.body_id;
  frame_.bodies.front().quality = 1.0;
}

void TrackerDevice::next(SimulatedDatagram& datagram) {
  // The tracker's crystal sets the pace, hence the drift in the sampling period, too.
  const double ticks = phase_ + count_;
  const double measured_s =
      ticks / world_->options.tracker_rate_hz / (1.0 + world_->tracker_clock_drift);

  frame_.number = first_number_ + count_;
  tell_time(measured_s);
  dtrack::Body& body = frame_.bodies.front();
  // Drawn also where it is hidden: what comes after stays as it was.
  body.room_from_body = measure(world_->room_from_hand(measured_s), measured_s);
  body.tracked = !interval_end_s(world_->tracker_faults, FaultKind::kOcclusion, measured_s);
  tell_covariance(measured_s);
  dtrack::format_datagram(frame_, datagram.bytes);

  const double jitter_s =
      std::min(arrivals_.exponential(world_->tracker_jitter_s), kLargestJitterS);
  const std::int64_t arrival_ns =
      world_->host_ns(measured_s + world_->tracker_latency_s + jitter_s);
  datagram.measured_s = measured_s;
  datagram.arrival_ns = std::max(arrival_ns, last_arrival_ns_ + kClosestArrivalsNs);
  last_arrival_ns_ = datagram.arrival_ns;
  ++count_;
}

void TrackerDevice::tell_time(double measured_s) {
  switch (world_->options.timestamps) {
    case Timestamps::kSecondsOfDay:
      frame_.seconds_of_day = world_->tracker_clock_s(measured_s);
      break;
    case Timestamps::kUnixTime: {
      const auto since_1970_us =
          kDayOfUnixTime * 86'400'000'000 + std::llround(1e6 * world_->tracker_day_s(measured_s));
      frame_.unix_time = dtrack::UnixTime{
          .seconds = static_cast<std::uint32_t>(since_1970_us / 1'000'000),
          .microseconds = static_cast<std::uint32_t>(since_1970_us % 1'000'000),
          .latency_us = static_cast<std::uint32_t>(std::llround(1e6 * world_->tracker_latency_s))};
      break;
    }
    case Timestamps::kNone:
      break;
  }
}

void TrackerDevice::tell_covariance(double measured_s) {
  frame_.covariances.clear();
  const dtrack::Body& body = frame_.bodies.front();
  if (!world_->options.covariance || !body.tracked) return;
  frame_.covariances.push_back(
      {.id = body.id,
       .reference_point_mm = body.room_from_body.translation(),
       .covariance = euler_covariance(sight_.covariance(measured_s),
                                      dtrack::euler_angles_rad(body.room_from_body.linear()))});
}

Pose TrackerDevice::measure(const Pose& room_from_hand, double measured_s) {
  const SimulatorOptions& options = world_->options;
  if (options.covariance) return sight_.measure(room_from_hand, measured_s, noise_);
  Pose measured = room_from_hand;
  measured.linear() *= exp_so3(noise_.normal_vector(rad_from_deg(options.tracker_noise_deg)));
  measured.translation() += noise_.normal_vector(options.tracker_noise_mm);
  return measured;
}

}  // namespace handeye::simulator
