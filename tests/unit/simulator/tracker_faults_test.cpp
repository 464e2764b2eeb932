// SPDX-License-Identifier: BSD-3-Clause
// What a tracker says of the time, of how well it sees, and when it does not see.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "drivers/dtrack/formatter.hpp"
#include "drivers/dtrack/parser.hpp"
#include "drivers/simulator/tracker_device.hpp"

namespace handeye::simulator {
namespace {

constexpr std::int64_t kStartNs = 77'000'000'000;
constexpr double kDay_s = 86400.0;

using Check = std::function<void(const SimulatedDatagram&, const dtrack::Frame&)>;

void for_each_datagram(const World& world, int count, const Check& check) {
  TrackerDevice tracker(world);
  dtrack::Parser parser;
  SimulatedDatagram datagram;
  dtrack::Frame frame;
  for (int i = 0; i < count; ++i) {
    tracker.next(datagram);
    ASSERT_EQ(parser.parse(datagram.bytes, frame), dtrack::ParseStatus::kComplete)
        << datagram.bytes;
    check(datagram, frame);
  }
}

/// Drawn once: its surface takes a second.
const World& usual_world() {
  static const World world({.seed = 44}, kStartNs);
  return world;
}

World world_of(const char* fault) {
  World world = usual_world();
  world.tracker_faults.push_back(tracker_fault(fault));
  return world;
}

TEST(TrackerFaults, AHiddenBodyIsNotListedAndAllElseStays) {
  const World world = world_of("occlusion@2=1");
  TrackerDevice free_tracker(usual_world());
  SimulatedDatagram free;
  for_each_datagram(world, 300, [&](const SimulatedDatagram& datagram, const dtrack::Frame& frame) {
    free_tracker.next(free);
    const bool hidden = datagram.measured_s >= 2 && datagram.measured_s < 3;
    EXPECT_EQ(frame.bodies.empty(), hidden);
    EXPECT_EQ(datagram.arrival_ns, free.arrival_ns);
    if (!hidden) {
      EXPECT_EQ(datagram.bytes, free.bytes);
    }
  });
}

TEST(TrackerFaults, AClockThatJumpsGoesOnFromThere) {
  const World world = world_of("clock-jump@2=-0.3");
  for_each_datagram(world, 300, [&](const SimulatedDatagram& datagram, const dtrack::Frame& frame) {
    const double jumped_s =
        *frame.seconds_of_day - usual_world().tracker_clock_s(datagram.measured_s);
    EXPECT_NEAR(jumped_s, datagram.measured_s < 2 ? 0 : -0.3, 1e-6);
  });
}

TEST(TrackerFaults, TheDayEndsWhenToldTo) {
  const World world({.seed = 44, .midnight_s = 2.0}, kStartNs);
  for_each_datagram(world, 300, [&](const SimulatedDatagram& datagram, const dtrack::Frame& frame) {
    const double since_s = datagram.measured_s - 2;
    EXPECT_NEAR(*frame.seconds_of_day, since_s < 0 ? kDay_s + since_s : since_s, 3e-4);
  });
}

TEST(TrackerFaults, UnixTimeRunsOnThroughMidnight) {
  const World world({.seed = 44, .midnight_s = 2.0, .timestamps = Timestamps::kUnixTime}, kStartNs);
  double first_s = 0;
  for_each_datagram(world, 300, [&](const SimulatedDatagram& datagram, const dtrack::Frame& frame) {
    EXPECT_FALSE(frame.seconds_of_day.has_value());
    ASSERT_TRUE(frame.unix_time.has_value());
    const double unix_s = frame.unix_time->seconds + 1e-6 * frame.unix_time->microseconds;
    if (first_s == 0) first_s = unix_s - datagram.measured_s;
    EXPECT_NEAR(unix_s - first_s, datagram.measured_s, 3e-4);
    EXPECT_NEAR(std::remainder(unix_s - (datagram.measured_s - 2), kDay_s), 0, 1e-3);
  });
}

TEST(TrackerFaults, SomeTrackersSayNoTime) {
  World world = usual_world();
  world.options.timestamps = Timestamps::kNone;
  for_each_datagram(world, 10, [](const SimulatedDatagram&, const dtrack::Frame& frame) {
    EXPECT_FALSE(frame.seconds_of_day || frame.unix_time);
  });
}

/// Turns what 6dcov says of the Euler angles into an error of the rotation by finite differences,
/// so that the simulator's own conversion is not needed.
Matrix6d room_covariance(const dtrack::BodyCovariance& said, const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d angles = dtrack::euler_angles_rad(rotation);
  const auto rotation_of = [](const Eigen::Vector3d& a) -> Eigen::Matrix3d {
    return (Eigen::AngleAxisd(a.x(), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(a.y(), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(a.z(), Eigen::Vector3d::UnitZ()))
        .toRotationMatrix();
  };
  constexpr double kStep = 1e-6;
  Matrix6d room_from_wire = Matrix6d::Zero();
  room_from_wire.bottomLeftCorner<3, 3>().setIdentity();
  for (int i = 0; i < 3; ++i) {
    room_from_wire.block<3, 1>(0, 3 + i) =
        log_so3(rotation_of(angles + kStep * Eigen::Vector3d::Unit(i)) *
                rotation_of(angles).transpose()) /
        kStep;
  }
  return room_from_wire * said.covariance * room_from_wire.transpose();
}

TEST(TrackerFaults, TheCovarianceThatIsSaidIsTrue) {
  World world = usual_world();
  world.options.covariance = true;
  constexpr int kCount = 6000;
  double squares = 0;
  double rotation_variance = 0;
  double translation_variance = 0;
  double least = 1e9;
  double most = 0;
  for_each_datagram(
      world, kCount, [&](const SimulatedDatagram& datagram, const dtrack::Frame& frame) {
        ASSERT_EQ(frame.covariances.size(), 1U);
        const Pose& measured = frame.bodies.front().room_from_body;
        const Pose truth = world.room_from_hand(datagram.measured_s);
        const Matrix6d covariance = room_covariance(frame.covariances.front(), measured.linear());
        Eigen::Matrix<double, 6, 1> error;
        error << log_so3(measured.linear() * truth.linear().transpose()),
            measured.translation() - truth.translation();
        squares += error.dot(covariance.ldlt().solve(error));
        rotation_variance += covariance.topLeftCorner<3, 3>().trace() / 3;
        translation_variance += covariance.bottomRightCorner<3, 3>().trace() / 3;
        least = std::min(least, covariance.bottomRightCorner<3, 3>().trace());
        most = std::max(most, covariance.bottomRightCorner<3, 3>().trace());
      });
  // chi^2 of six: a standard deviation of sqrt(12 / 6000) = 0.045.
  EXPECT_NEAR(squares / kCount, 6, 0.2);
  EXPECT_NEAR(std::sqrt(rotation_variance / kCount), rad_from_deg(0.06), 0.2 * rad_from_deg(0.06));
  EXPECT_NEAR(std::sqrt(translation_variance / kCount), 0.15, 0.2 * 0.15);
  EXPECT_GT(most, 5 * least) << "varies with time";
}

}  // namespace
}  // namespace handeye::simulator
