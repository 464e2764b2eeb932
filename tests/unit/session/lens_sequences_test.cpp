// SPDX-License-Identifier: BSD-3-Clause
// The whole way of `handeye replay --intrinsics` on rendered recordings: the lens is found from the
// images, and the hand-eye transformation with it.
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/session/replay.hpp"
#include "drivers/recording/recording.hpp"
#include "drivers/simulator/field_stop.hpp"
#include "drivers/simulator/record.hpp"
#include "tests/sequences/lens_error.hpp"
#include "tests/sequences/sequence.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye {
namespace {

using simulator::World;

constexpr double kDuration_s = 8.0;
constexpr double kMostFocal_percent = 0.5;
constexpr double kMostDistortion_px = 1.0;
constexpr double kHonest = 3.5;  // error in its own standard deviations

/// 255 where the scope shows something: all of the image but for a round stop.
cv::Mat field_of_view(const World& world) {
  cv::Mat shown(world.options.height, world.options.width, CV_8UC1, cv::Scalar(255));
  if (!world.options.disturbances.round_view) return shown;
  const simulator::FieldStop stop(world.options.width, world.options.height, world.options.seed);
  shown.setTo(0);
  cv::circle(shown,
             {static_cast<int>(stop.centre_px().x()), static_cast<int>(stop.centre_px().y())},
             static_cast<int>(stop.radius_px()), 255, cv::FILLED);
  return shown;
}

/// The lens of a neighbouring scope.
CameraModel poorly_calibrated(CameraModel camera) {
  camera.fx *= 1.03;
  camera.fy *= 1.03;
  camera.cx += 10.0;
  camera.cy -= 10.0;
  return camera;
}

class LensSequences : public testing::TestWithParam<const char*> {
 protected:
  LensSequences()
      : world_(sequences::Sequence(GetParam()).world()),
        recording_(folder_ / "recording"),
        poor_camera_(folder_ / "camera.json") {
    simulator::record(world_, kDuration_s, recording_);
    write_camera_model(poor_camera_, poorly_calibrated(world_.camera));
  }

  void expect_right(const CalibrationResult& result) const {
    ASSERT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
    ASSERT_TRUE(result.lens.has_value());
    const LensSigma& sigma = result.lens->sigma;
    const auto error = sequences::lens_error(world_.camera, result.camera, field_of_view(world_));
    const Pose& truth = world_.hand_from_eye;
    const Pose& found = result.solution.hand_from_eye;
    const double turned_deg = deg_from_rad(rotation_angle_rad(found.linear(), truth.linear()));
    const double moved_mm = (found.translation() - truth.translation()).norm();
    std::printf(
        "%s: focal length off by %.3f %% (sigma %.3f), distortion by %.2f px (sigma %.2f), "
        "hand_from_eye by %.3f deg (sigma %.3f) and %.2f mm (sigma %.2f); %.0f ms\n",
        GetParam(), error.focal_percent, 100 * sigma.focal_px / world_.camera.fx,
        error.distortion_px, sigma.distortion_px, turned_deg, result.sigma_rotation_deg, moved_mm,
        result.sigma_translation_mm, result.timings_ms.total);
    EXPECT_TRUE(result.lens->observable);
    EXPECT_LT(error.focal_percent, kMostFocal_percent);
    EXPECT_LT(error.distortion_px, kMostDistortion_px);
    EXPECT_LT(error.distortion_px, kHonest * sigma.distortion_px);
    EXPECT_LT(turned_deg, kHonest * result.sigma_rotation_deg);
    EXPECT_LT(moved_mm, kHonest * result.sigma_translation_mm);
  }

  TemporaryFolder folder_;
  World world_;
  std::filesystem::path recording_;
  std::filesystem::path poor_camera_;
};

TEST_P(LensSequences, TellTheLensByThemselves) {
  std::filesystem::remove(recording_ / "camera.json");
  const CalibrationResult result =
      replay({.recording = recording_, .intrinsics = IntrinsicsMode::kEstimate});
  EXPECT_EQ(result.camera_source, "estimated");
  expect_right(result);
}

INSTANTIATE_TEST_SUITE_P(MustHave, LensSequences,
                         testing::Values("plain", "flicker", "highlights", "round_mask",
                                         "distortion", "blur", "noise", "missing_frames"),
                         [](const auto& sequence) { return std::string(sequence.param); });

class PoorlyCalibrated : public LensSequences {};

TEST_P(PoorlyCalibrated, AreRefined) {
  const CalibrationResult result = replay({.recording = recording_,
                                           .camera_file = poor_camera_,
                                           .intrinsics = IntrinsicsMode::kRefine});
  EXPECT_EQ(result.camera_source, "refined");
  expect_right(result);
}

INSTANTIATE_TEST_SUITE_P(Some, PoorlyCalibrated, testing::Values("plain", "distortion"),
                         [](const auto& sequence) { return std::string(sequence.param); });

}  // namespace
}  // namespace handeye
