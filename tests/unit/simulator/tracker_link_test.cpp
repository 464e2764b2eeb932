// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/tracker_link.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include <gtest/gtest.h>

namespace handeye::simulator {
namespace {

constexpr std::int64_t kStartNs = 77'000'000'000;
constexpr int kSent = 3'000;

/// Drawn once: its surface takes a second.
const World& usual_world() {
  static const World world({.seed = 4}, kStartNs);
  return world;
}

std::vector<SimulatedDatagram> arrived(const std::vector<const char*>& faults,
                                       std::uint64_t seed = 4) {
  World world = usual_world();
  world.options.seed = seed;
  for (const char* const fault : faults) world.tracker_faults.push_back(tracker_fault(fault));
  TrackerLink link(world);
  std::vector<SimulatedDatagram> datagrams;
  const double duration_s = kSent / world.options.tracker_rate_hz;
  SimulatedDatagram datagram;
  for (link.next(datagram); datagram.measured_s < duration_s; link.next(datagram)) {
    datagrams.push_back(datagram);
  }
  return datagrams;
}

std::size_t overtaken(const std::vector<SimulatedDatagram>& datagrams) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < datagrams.size(); ++i) {
    if (datagrams[i].measured_s < datagrams[i - 1].measured_s) ++count;
  }
  return count;
}

bool in_order_of_arrival(const std::vector<SimulatedDatagram>& datagrams) {
  return std::ranges::is_sorted(datagrams, {}, &SimulatedDatagram::arrival_ns);
}

TEST(TrackerLink, ChangesNothingUnlessAsked) {
  TrackerDevice device(usual_world());
  SimulatedDatagram sent;
  const auto datagrams = arrived({});
  EXPECT_EQ(datagrams.size(), kSent);
  for (const SimulatedDatagram& datagram : datagrams) {
    device.next(sent);
    EXPECT_EQ(datagram.bytes, sent.bytes);
    EXPECT_EQ(datagram.arrival_ns, sent.arrival_ns);
  }
}

TEST(TrackerLink, LosesItsShare) {
  const auto datagrams = arrived({"lost"});
  EXPECT_NEAR(1 - static_cast<double>(datagrams.size()) / kSent, 0.08, 0.015);
  EXPECT_EQ(overtaken(datagrams), 0U);
}

TEST(TrackerLink, LetsTheNextOvertake) {
  const auto datagrams = arrived({"reordered"});
  EXPECT_EQ(datagrams.size(), kSent);
  EXPECT_TRUE(in_order_of_arrival(datagrams));
  EXPECT_NEAR(static_cast<double>(overtaken(datagrams)) / kSent, 0.075, 0.02);
}

TEST(TrackerLink, SendsSomeTwice) {
  const auto datagrams = arrived({"duplicated"});
  std::map<std::string, int> copies;
  for (const SimulatedDatagram& datagram : datagrams) ++copies[datagram.bytes];
  EXPECT_EQ(copies.size(), kSent);
  EXPECT_NEAR(static_cast<double>(datagrams.size()) / kSent, 1.08, 0.015);
  EXPECT_TRUE(in_order_of_arrival(datagrams));
}

TEST(TrackerLink, HoldsBackAndReleasesAtOnce) {
  const auto datagrams = arrived({"bursts"});
  const auto usual = arrived({});
  ASSERT_EQ(datagrams.size(), usual.size());
  EXPECT_TRUE(in_order_of_arrival(datagrams));
  EXPECT_EQ(overtaken(datagrams), 0U);
  int late = 0;
  std::int64_t longest_ns = 0;
  for (std::size_t i = 0; i < usual.size(); ++i) {
    const std::int64_t late_ns = datagrams[i].arrival_ns - usual[i].arrival_ns;
    ASSERT_GE(late_ns, 0);
    if (late_ns > 0) ++late;
    longest_ns = std::max(longest_ns, late_ns);
  }
  EXPECT_NEAR(static_cast<double>(late) / kSent, 0.1, 0.01) << "0.2 s of every 2 s";
  EXPECT_NEAR(static_cast<double>(longest_ns), 2e8, 2e7);
}

TEST(TrackerLink, SameSeedSameFate) {
  const std::vector<const char*> faults{"lost", "reordered", "duplicated", "bursts"};
  const auto once = arrived(faults);
  const auto again = arrived(faults);
  const auto other = arrived(faults, 5);
  ASSERT_EQ(once.size(), again.size());
  EXPECT_TRUE(in_order_of_arrival(once));
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].bytes, again[i].bytes);
    EXPECT_EQ(once[i].arrival_ns, again[i].arrival_ns);
  }
  EXPECT_NE(once.back().arrival_ns, other.back().arrival_ns);
}

}  // namespace
}  // namespace handeye::simulator
