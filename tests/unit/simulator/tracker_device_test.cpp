// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/tracker_device.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/dtrack/parser.hpp"

namespace handeye::simulator {
namespace {

constexpr std::int64_t kStartNs = 77'000'000'000;
constexpr int kDatagrams = 3'000;

class TrackerDeviceTest : public testing::Test {
 protected:
  static SimulatorOptions options() {
    SimulatorOptions options;
    options.seed = 44;
    options.body_id = 2;
    return options;
  }

  World world_{options(), kStartNs};
};

TEST_F(TrackerDeviceTest, SaysWhereTheHandIsWithinItsNoise) {
  TrackerDevice tracker(world_);
  SimulatedDatagram datagram;
  dtrack::Parser parser;
  dtrack::Frame frame;
  Eigen::Array3d rotation_square = Eigen::Array3d::Zero();
  Eigen::Array3d translation_square = Eigen::Array3d::Zero();
  std::uint32_t last_number = 0;
  for (int i = 0; i < kDatagrams; ++i) {
    tracker.next(datagram);
    ASSERT_EQ(parser.parse(datagram.bytes, frame), dtrack::ParseStatus::kComplete);
    if (i > 0) {
      EXPECT_EQ(frame.number, last_number + 1);
    }
    last_number = frame.number;
    EXPECT_EQ(frame.calibrated_bodies, 3);
    ASSERT_EQ(frame.bodies.size(), 1U);
    const dtrack::Body* body = frame.find_body(2);
    ASSERT_NE(body, nullptr);
    ASSERT_TRUE(body->tracked);
    const Pose truth = world_.room_from_hand(datagram.measured_s);
    const Pose error = truth.inverse() * body->room_from_body;
    rotation_square += log_so3(error.linear()).array().square();
    translation_square += error.translation().array().square();
  }
  const Eigen::Array3d sigma_deg = (rotation_square / kDatagrams).sqrt() * (180.0 / kPi);
  const Eigen::Array3d sigma_mm = (translation_square / kDatagrams).sqrt();
  // 3000 samples: the sigma of a sigma is 1.3 %.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sigma_deg[axis], 0.06, 0.004);
    EXPECT_NEAR(sigma_mm[axis], 0.15, 0.010);
  }
}

TEST_F(TrackerDeviceTest, ArrivesInOrderAndNeverBeforeTheConstantLatency) {
  TrackerDevice tracker(world_);
  SimulatedDatagram datagram;
  std::int64_t last_arrival_ns = 0;
  double earliest_s = 1.0;
  double sum_s = 0;
  for (int i = 0; i < kDatagrams; ++i) {
    tracker.next(datagram);
    EXPECT_GT(datagram.arrival_ns, last_arrival_ns);
    last_arrival_ns = datagram.arrival_ns;
    const double late_s =
        1e-9 * static_cast<double>(datagram.arrival_ns - kStartNs) - datagram.measured_s;
    earliest_s = std::min(earliest_s, late_s);
    sum_s += late_s;
  }
  EXPECT_GE(earliest_s, world_.tracker_latency_s - 1e-9);
  EXPECT_LE(earliest_s, world_.tracker_latency_s + 20e-6);
  EXPECT_NEAR(sum_s / kDatagrams, world_.tracker_latency_s + world_.tracker_jitter_s, 1e-4);
}

TEST_F(TrackerDeviceTest, CountsByItsOwnClock) {
  world_.tracker_clock_drift = 50e-6;
  TrackerDevice tracker(world_);
  SimulatedDatagram datagram;
  dtrack::Parser parser;
  dtrack::Frame frame;
  double first_measured_s = 0;
  double first_clock_s = 0;
  for (int i = 0; i < kDatagrams; ++i) {
    tracker.next(datagram);
    parser.parse(datagram.bytes, frame);
    ASSERT_TRUE(frame.seconds_of_day.has_value());
    if (i == 0) {
      first_measured_s = datagram.measured_s;
      first_clock_s = *frame.seconds_of_day;
    }
    // Its own clock ticks 60 times a second, to the microsecond that is printed.
    EXPECT_NEAR(*frame.seconds_of_day - first_clock_s, i / 60.0, 2e-6);
  }
  const double host_s = datagram.measured_s - first_measured_s;
  EXPECT_NEAR((*frame.seconds_of_day - first_clock_s) / host_s - 1.0, 50e-6, 1e-7);
}

TEST_F(TrackerDeviceTest, SameSeedSameBytes) {
  TrackerDevice tracker(world_);
  TrackerDevice again(world_);
  SimulatorOptions other_options = options();
  other_options.seed = 45;
  const World other_world(other_options, kStartNs);
  TrackerDevice other(other_world);
  SimulatedDatagram datagram;
  SimulatedDatagram datagram_again;
  SimulatedDatagram datagram_other;
  for (int i = 0; i < 100; ++i) {
    tracker.next(datagram);
    again.next(datagram_again);
    other.next(datagram_other);
    EXPECT_EQ(datagram.bytes, datagram_again.bytes);
    EXPECT_EQ(datagram.arrival_ns, datagram_again.arrival_ns);
    EXPECT_NE(datagram.bytes, datagram_other.bytes);
  }
}

}  // namespace
}  // namespace handeye::simulator
