// SPDX-License-Identifier: BSD-3-Clause
// A calibration from before a restart is marked wherever it shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/service/calibration_in_use.hpp"
#include "daemon/service/pose_publisher.hpp"
#include "daemon/service/status_message.hpp"
#include "daemon/session/age_text.hpp"
#include "daemon/session/result_json.hpp"
#include "daemon/session/result_message.hpp"

namespace handeye {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kNow_ns = 5'000'000'000;
constexpr const char* kChannel = "CAMERA_POSE";

CalibrationResult restored_result(std::optional<double> age_s) {
  CalibrationResult result;
  result.request_id = 8;
  result.verdict = Verdict::kAccepted;
  result.vintage = Vintage{.solved_utime = 1'790'000'000'000'000, .age_s = age_s, .restored = true};
  result.camera = {640, 480, 500, 501, 320, 240, {}};
  return result;
}

/// Flags and age of a pose published for a frame at `now_ns`, with a tracker that is silent.
class RestoredPose : public testing::Test {
 protected:
  RestoredPose() {
    bus_.subscribe<camera_pose_t>(kChannel, [this](const camera_pose_t& pose) { heard_ = pose; });
  }
  const camera_pose_t& pose_at(std::int64_t now_ns) {
    publisher_.add_frame({now_ns, 1, now_ns});
    publisher_.publish_ready(now_ns + 1'000'000'000);
    while (bus_.handle(std::chrono::milliseconds(20))) {
    }
    return heard_;
  }

  Bus bus_{"memq://"};
  PosePublisher publisher_{bus_, kChannel};
  camera_pose_t heard_{};
};

TEST_F(RestoredPose, IsFlaggedUntilTheWatchHasSeenItHold) {
  publisher_.use(active_calibration(restored_result(7200), {}, kNow_ns));
  EXPECT_EQ(pose_at(kNow_ns).flags, camera_pose_t::FLAG_RESTORED);
  EXPECT_EQ(heard_.calibration_age_s, 7201) << "a second after the frame";
  publisher_.hear({8, status_t::WATCH_UNCHECKED});
  EXPECT_EQ(pose_at(kNow_ns).flags, camera_pose_t::FLAG_RESTORED);
  publisher_.hear({8, status_t::WATCH_DOUBTFUL});
  EXPECT_EQ(pose_at(kNow_ns).flags,
            +camera_pose_t::FLAG_RESTORED | +camera_pose_t::FLAG_CALIBRATION_DOUBTFUL);
  publisher_.hear({7, status_t::WATCH_HOLDS});
  EXPECT_NE(pose_at(kNow_ns).flags & camera_pose_t::FLAG_RESTORED, 0) << "another calibration";
  publisher_.hear({8, status_t::WATCH_HOLDS});
  EXPECT_EQ(pose_at(kNow_ns).flags, 0);
  publisher_.hear({8, status_t::WATCH_BROKEN});
  EXPECT_EQ(pose_at(kNow_ns).flags, camera_pose_t::FLAG_CALIBRATION_BROKEN);
}

TEST_F(RestoredPose, MayBeOfUnknownAge) {
  publisher_.use(active_calibration(restored_result(std::nullopt), {}, kNow_ns));
  EXPECT_EQ(pose_at(kNow_ns).calibration_age_s, -1);
}

TEST_F(RestoredPose, ANewOneIsNotFlagged) {
  CalibrationResult result = restored_result(0);
  result.vintage->restored = false;
  publisher_.use(active_calibration(result, {}, kNow_ns));
  EXPECT_EQ(pose_at(kNow_ns).flags, 0);
}

TEST(RestoredStatus, TellsAgeAndThatItIsRestored) {
  status_t status{};
  write_calibration(std::nullopt, kNow_ns, status);
  EXPECT_FALSE(status.calibrated);
  EXPECT_EQ(status.calibration_age_s, -1);
  write_calibration(active_calibration(restored_result(60), {}, kNow_ns), kNow_ns + 500'000'000,
                    status);
  EXPECT_TRUE(status.calibrated);
  EXPECT_EQ(status.calibration_request_id, 8);
  EXPECT_DOUBLE_EQ(status.calibration_age_s, 60.5);
  EXPECT_TRUE(status.calibration_restored);
}

TEST(RestoredResult, SurvivesTheJourneyOverLcm) {
  for (const auto age_s : {std::optional(61.5), std::optional<double>()}) {
    const CalibrationResult result = restored_result(age_s);
    const CalibrationResult received = from_message(to_message(result));
    ASSERT_TRUE(received.vintage.has_value());
    EXPECT_EQ(received.vintage->age_s, age_s);
    EXPECT_EQ(to_json(received), to_json(result));
  }
}

TEST(RestoredResult, AReplaysHasNoVintage) {
  CalibrationResult result = restored_result(1);
  result.vintage.reset();
  EXPECT_FALSE(from_message(to_message(result)).vintage.has_value());
  EXPECT_FALSE(to_json(result).contains("age_s")) << "the same answer every time";
}

TEST(Misfit, IsAnotherPictureSizeOrAnotherGivenLens) {
  CalibrationResult result = restored_result(1);
  CameraModel camera = result.camera;
  EXPECT_EQ(misfit(result, camera), std::nullopt);
  camera.fx += 1e-9;
  EXPECT_THAT(misfit(result, camera).value_or(""), HasSubstr("intrinsics"));
  result.lens = LensQuality{};
  EXPECT_EQ(misfit(result, camera), std::nullopt) << "it was found, not given";
  camera.width = 1280;
  EXPECT_THAT(misfit(result, camera).value_or(""), HasSubstr("1280x480"));
}

TEST(AgeText, IsForAPerson) {
  EXPECT_EQ(age_text(0.4), "0 s old");
  EXPECT_EQ(age_text(119), "1 min old");
  EXPECT_EQ(age_text(7260), "2 h 1 min old");
  EXPECT_EQ(age_text(47 * 3600 + 3599), "47 h 59 min old");
  EXPECT_EQ(age_text(72 * 3600), "3 days old");
  EXPECT_EQ(age_text(std::nullopt), "of unknown age");
}

}  // namespace
}  // namespace handeye
