// SPDX-License-Identifier: BSD-3-Clause
// What a tracker sends over UDP, as it comes to the solver and to the watch.
#include "daemon/service/tracker_thread.hpp"

#include <chrono>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "drivers/simulator/sight_noise.hpp"
#include "drivers/simulator/tracker_device.hpp"
#include "drivers/simulator/udp_sender.hpp"
#include "protocol/bus.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds kLong{10'000};
constexpr int kDatagrams = 40;
constexpr std::uint64_t kCalibration = 7;

class TrackerThreadTest : public testing::Test {
 protected:
  TrackerThreadTest() : thread_(config(), {}, bus_, Channels()) {
    thread_.begin_collecting(0, kCalibration);
    thread_.start();
  }

  static Config::Tracker config() {
    Config::Tracker config;
    config.port = 0;
    config.bind_address = "127.0.0.1";
    return config;
  }

  Bus bus_{"memq://"};
  TrackerThread thread_;
};

/// The tracker's own word on each measurement (6dcov), from the wire to the solver.
TEST_F(TrackerThreadTest, HandsOnWhatTheTrackerSaysOfItsUncertainty) {
  const simulator::World world({.seed = 5, .covariance = true}, 0);
  const simulator::SightNoise truth(world.options.seed,
                                    rad_from_deg(world.options.tracker_noise_deg),
                                    world.options.tracker_noise_mm);
  simulator::TrackerDevice tracker(world);
  const simulator::UdpSender sender("127.0.0.1", thread_.port());
  simulator::SimulatedDatagram datagram;
  int tracked = 0;
  const std::int64_t start_ns = monotonic_ns();
  for (int i = 0; i < kDatagrams; ++i) {
    tracker.next(datagram);
    std::this_thread::sleep_for(nanoseconds(start_ns + datagram.arrival_ns - monotonic_ns()));
    ASSERT_TRUE(sender.send(datagram.bytes));
    const auto item = thread_.hand_samples().pop(kLong);
    ASSERT_TRUE(item.has_value()) << "datagram " << i;
    EXPECT_EQ(item->calibration, kCalibration);
    ASSERT_TRUE(item->sample.covariance.has_value()) << "datagram " << i;
    const Matrix6d expected = truth.covariance(datagram.measured_s);
    const Vector6d whitening = expected.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix6d difference = whitening.asDiagonal() *
                                (item->sample.covariance->cast<double>() - expected) *
                                whitening.asDiagonal();
    // Four digits on the wire; the angles it tells of are those of the noisy measurement.
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 5e-3) << "datagram " << i;
    tracked += item->sample.tracked ? 1 : 0;
  }
  EXPECT_GT(tracked, kDatagrams / 2) << "of the others the clock is not yet known";
}

/// Two calibrations one after the other, of two bodies: the watch can tell whose hand it is.
TEST_F(TrackerThreadTest, TellsTheWatchWhichCalibrationAHandIsOf) {
  thread_.use({.request_id = 9, .body_id = 0});
  const simulator::World world({.seed = 5, .body_id = 1}, 0);
  simulator::TrackerDevice tracker(world);
  const simulator::UdpSender sender("127.0.0.1", thread_.port());
  simulator::SimulatedDatagram datagram;
  const auto next_watched = [&] {
    tracker.next(datagram);
    sender.send(datagram.bytes);
    return thread_.watched_hand().pop(milliseconds(100));
  };
  const auto until_of = [&](std::int64_t request_id) {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    std::optional<WatchedHand> hand;
    while (!hand || hand->request_id != request_id) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      hand = next_watched();
    }
    return true;
  };
  ASSERT_TRUE(until_of(9));
  thread_.use({.request_id = 10, .body_id = 1});
  ASSERT_TRUE(until_of(10));
  for (int i = 0; i < 10; ++i) {
    const auto hand = next_watched();
    ASSERT_TRUE(hand.has_value());
    EXPECT_EQ(hand->request_id, 10);
    EXPECT_FALSE(hand->sample.room_from_hand.isApprox(Pose::Identity())) << "the body that is seen";
  }
}

}  // namespace
}  // namespace handeye
