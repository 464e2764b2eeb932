// SPDX-License-Identifier: BSD-3-Clause
// After a calibration the camera head is turned: the daemon sees it in the live images and says so.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::duration;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr double kCalibration_s = 12;
constexpr double kTurned_s = 32;  ///< after the simulator's start
constexpr double kTurn_deg = 5;
/// 10 s of motion, and what a busy machine takes longer.
constexpr double kMostDelay_s = 20;

class WatchSystem : public RoomTest {
 protected:
  bool heard_watch(std::int32_t state) const {
    return std::ranges::any_of(room_.listener().statuses(),
                               [&](const status_t& status) { return status.watch_state == state; });
  }

  mutable Room room_;
};

TEST_F(WatchSystem, ATurnedHeadIsSaid) {
  ASSERT_TRUE(room_.start_simulator(
      {.seed = 6,
       .extra_words = {"--turn-head", fmt::format("{}:{}:roll", kTurned_s, kTurn_deg)}}));
  // The simulator's time begins soon after it has written its files.
  const auto began = steady_clock::now();
  const auto elapsed_s = [&] { return duration<double>(steady_clock::now() - began).count(); };
  ASSERT_TRUE(room_.start_daemon());
  Listener& listener = room_.listener();
  const request_t start = start_request(kCalibration_s);
  ASSERT_TRUE(listener.ask(start));
  ASSERT_TRUE(listener.spin_until([&] { return listener.result_of(start.request_id) != nullptr; },
                                  seconds(60)));
  ASSERT_EQ(listener.result_of(start.request_id)->verdict, result_t::ACCEPTED)
      << listener.result_of(start.request_id)->reason;

  listener.hear_poses();
  const bool broken =
      listener.spin_until([&] { return heard_watch(status_t::WATCH_BROKEN); }, seconds(60));
  const double delay_s = elapsed_s() - kTurned_s;
  ASSERT_TRUE(broken) << listener.statuses().back().watch_text;
  EXPECT_TRUE(heard_watch(status_t::WATCH_HOLDS)) << "before it was turned";
  std::printf("the turn was said %.1f s after it\n", delay_s);
  EXPECT_GT(delay_s, 0) << "said before it was turned";
  EXPECT_LT(delay_s, kMostDelay_s);
  const status_t& status = listener.statuses().back();
  EXPECT_NEAR(status.watch_deviation_deg, kTurn_deg, 2);
  EXPECT_GT(status.watch_deviation_sigma_deg, 0);

  Process client(room_.client_words("status", {"--json"}));
  ASSERT_TRUE(listener.spin_until([&] { return client.has_ended(); }, seconds(30)));
  const nlohmann::json said = parse_json(client.wait(seconds(0))->out);
  EXPECT_EQ(said.at("watch").at("state"), "broken") << said.dump();
  EXPECT_TRUE(std::ranges::any_of(listener.poses(), [](const camera_pose_t& pose) {
    return (pose.flags & camera_pose_t::FLAG_CALIBRATION_BROKEN) != 0;
  })) << "CAMERA_POSE carries it too";
}

}  // namespace
}  // namespace handeye::test
