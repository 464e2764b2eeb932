// SPDX-License-Identifier: BSD-3-Clause
// The last accepted calibration outlives the daemon, however that ends.
#include <csignal>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "daemon/service/calibration_store.hpp"
#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

constexpr seconds kSoon{20};
constexpr seconds kCalibrationTimeout{120};
constexpr seconds kServesAgain{5};

/// Answers to nothing, but complete.
CalibrationResult some_result() {
  CalibrationResult result;
  result.request_id = 4711;
  result.verdict = Verdict::kAccepted;
  result.vintage = Vintage{.solved_utime = realtime_us() - 7'200'000'000, .age_s = 0};
  result.has_estimate = true;
  result.method = "one_step";
  result.covariance = 1e-6 * Matrix6d::Identity();
  result.camera = {640, 480, 500, 500, 320, 240, {}};
  return result;
}

class KeptSystem : public RoomTest {
 protected:
  DaemonSettings settings(const std::string& more = "") const {
    return {.extra_lines = "[calibration]\nstore = \"kept.json\"\n" + more};
  }
  const status_t& status() { return room_.listener().statuses().back(); }
  CalibrationStore store() const { return CalibrationStore(room_.path("kept.json")); }
  void kill_daemon() {
    room_.daemon().send_signal(SIGKILL);
    ASSERT_TRUE(room_.daemon().wait(kSoon).has_value());
  }

  Room room_;
};

TEST_F(KeptSystem, SurvivesAKillInTheMiddleOfTheNextOne) {
  Listener& listener = room_.listener();
  ASSERT_TRUE(room_.start_simulator({.seed = 3, .camera_rate_hz = 15}));
  ASSERT_TRUE(room_.start_daemon(settings()));
  Process client(room_.client_words("calibrate", {"--json"}));
  ASSERT_TRUE(listener.spin_until([&] { return client.has_ended(); }, kCalibrationTimeout));
  ASSERT_EQ(client.wait(seconds(0))->exit_code, 0) << client.err();
  ASSERT_EQ(listener.results().size(), 1U);
  const result_t accepted = listener.results().front();
  EXPECT_FALSE(accepted.restored);
  EXPECT_LT(accepted.age_s, 5);
  EXPECT_GE(status().calibration_age_s, 0);
  EXPECT_FALSE(status().calibration_restored);

  ASSERT_TRUE(listener.ask(start_request(60)));
  ASSERT_TRUE(listener.spin_until([&] { return status().frames_collected > 20; }, kSoon));
  kill_daemon();
  listener.hear_poses();
  const auto killed = steady_clock::now();
  ASSERT_TRUE(room_.start_daemon(settings()));
  EXPECT_LT(steady_clock::now() - killed, kServesAgain);

  EXPECT_EQ(status().session_state, status_t::IDLE);
  EXPECT_TRUE(status().calibrated);
  EXPECT_EQ(status().calibration_request_id, accepted.request_id);
  EXPECT_TRUE(status().calibration_restored);
  EXPECT_GT(status().calibration_age_s, 0);
  ASSERT_TRUE(listener.spin_until([&] { return listener.results().size() > 1; }, kSoon));
  const result_t restored = listener.results().back();
  EXPECT_TRUE(restored.restored);
  EXPECT_EQ(restored.request_id, accepted.request_id);
  EXPECT_EQ(restored.solved_utime, accepted.solved_utime);
  EXPECT_GT(restored.age_s, accepted.age_s);
  EXPECT_NEAR(restored.t_mm[2], accepted.t_mm[2], 1e-9);
  EXPECT_EQ(restored.covariance[21], accepted.covariance[21]);
  EXPECT_EQ(restored.num_methods, accepted.num_methods);

  ASSERT_TRUE(listener.spin_until([&] { return !listener.poses().empty(); }, kSoon));
  const camera_pose_t first = listener.poses().front();
  EXPECT_EQ(first.calibration_request_id, accepted.request_id);
  EXPECT_NE(first.flags & camera_pose_t::FLAG_RESTORED, 0);
  // Until live images have shown that it holds.
  EXPECT_TRUE(listener.spin_until([&] { return !status().calibration_restored; }, seconds(90)))
      << status().watch_text;
  EXPECT_TRUE(listener.spin_until(
      [&] { return (listener.poses().back().flags & camera_pose_t::FLAG_RESTORED) == 0; }, kSoon));
}

TEST_F(KeptSystem, IsTakenUpWithoutAnyDeviceAndDescribed) {
  room_.write_camera_file(kSomeCamera);
  ASSERT_TRUE(store().save(some_result()));
  ASSERT_TRUE(room_.start_daemon(settings()));
  EXPECT_EQ(status().calibration_request_id, 4711);
  EXPECT_NEAR(status().calibration_age_s, 7200, 30);
  request_t describe = start_request(0);
  describe.action = request_t::DESCRIBE;
  const std::size_t before = room_.listener().results().size();
  ASSERT_TRUE(room_.listener().ask(describe));
  ASSERT_TRUE(room_.listener().spin_until(
      [&] { return room_.listener().results().size() > before; }, kSoon));
  EXPECT_NEAR(room_.listener().results().back().age_s, 7200, 30);
  EXPECT_THAT(run(room_.client_words("status")).out, HasSubstr("2 h 0 min old"));
}

TEST_F(KeptSystem, ADamagedOneIsPutAsideAndSaid) {
  room_.write_camera_file(kSomeCamera);
  write_bytes(room_.path("kept.json"), "{\"format\":\"handeyed calib");
  ASSERT_TRUE(room_.start_daemon(settings()));
  EXPECT_FALSE(status().calibrated);
  EXPECT_EQ(status().calibration_age_s, -1);
  EXPECT_THAT(room_.daemon().err(), HasSubstr("kept.json.damaged"));
  EXPECT_TRUE(std::filesystem::exists(room_.path("kept.json.damaged")));
}

TEST_F(KeptSystem, OneOfAnotherCameraIsNotUsed) {
  room_.write_camera_file(
      R"({"width":640,"height":480,"fx":501,"fy":500,"cx":320,"cy":240,"distortion":[0,0,0,0,0]})");
  ASSERT_TRUE(store().save(some_result()));
  ASSERT_TRUE(room_.start_daemon(settings()));
  EXPECT_FALSE(status().calibrated);
  EXPECT_THAT(room_.daemon().err(), HasSubstr("intrinsics have been changed"));
  EXPECT_TRUE(std::filesystem::exists(room_.path("kept.json"))) << "they may be changed back";
}

TEST_F(KeptSystem, WhoWantsNoneKeepsNone) {
  room_.write_camera_file(kSomeCamera);
  ASSERT_TRUE(store().save(some_result()));
  ASSERT_TRUE(room_.start_daemon(settings("keep = false\n")));
  EXPECT_FALSE(status().calibrated);
  EXPECT_FALSE(std::filesystem::exists(room_.path("kept.json")));
}

}  // namespace
}  // namespace handeye::test
