// SPDX-License-Identifier: BSD-3-Clause
// What a seed stands for stays: these figures are those of the simulator before it could disturb
// tracker and time. Seeds are quoted in tests, reports and bug reports.
#include <gtest/gtest.h>

#include "drivers/simulator/endoscope_device.hpp"
#include "drivers/simulator/tracker_link.hpp"

namespace handeye::simulator {
namespace {

constexpr std::int64_t kStartNs = 1'000'000'000'000;

const World& world() {
  static const World world({.seed = 7, .width = 160, .height = 120}, kStartNs);
  return world;
}

TEST(UnchangedSeed, SendsTheSameDatagrams) {
  TrackerLink tracker(world());
  SimulatedDatagram datagram;
  tracker.next(datagram);
  EXPECT_EQ(datagram.arrival_ns, 1'000'024'597'192);
  EXPECT_EQ(datagram.bytes,
            "fr 30363\r\nts 8092.553367\r\n6dcal 1\r\n6d 1 [0 1.000]"
            "[-312.483 -63.136 784.928 113.8356 -58.7721 53.7125]"
            "[0.306834 -0.788661 0.532791 -0.417896 0.391311 0.819902 -0.855111 -0.474225 "
            "-0.209511]\r\n");
  for (int i = 1; i < 120; ++i) tracker.next(datagram);
  EXPECT_EQ(datagram.arrival_ns, 1'002'007'744'778);
  EXPECT_EQ(datagram.bytes,
            "fr 30482\r\nts 8094.536701\r\n6dcal 1\r\n6d 1 [0 1.000]"
            "[-279.871 -107.265 762.291 110.5486 -31.8876 63.0527]"
            "[0.384781 -0.537050 0.750680 -0.756895 0.281874 0.589624 -0.528255 -0.795062 "
            "-0.298031]\r\n");
}

TEST(UnchangedSeed, TakesTheSamePictures) {
  EndoscopeDevice endoscope(world());
  SimulatedFrame frame;
  endoscope.make(10, frame);
  EXPECT_EQ(frame.timestamp_ns, 1'000'441'196'247);
  EXPECT_EQ(frame.arrival_ns, 1'000'443'196'247);
  EXPECT_NEAR(cv::sum(frame.grey)[0], 1'674'720, 10);
}

TEST(UnchangedSeed, HasTheSameTruth) {
  EXPECT_TRUE(world().hand_from_eye.translation().isApprox(
      Eigen::Vector3d(266.49447665095516, 146.54495619428008, 78.73812805514046), 1e-14));
  EXPECT_NEAR(world().time_offset_s(), 0.03192924691210468, 1e-15);
  EXPECT_NEAR(world().tracker_clock_start_s, 8092.538246236971, 1e-9);
}

}  // namespace
}  // namespace handeye::simulator
