// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration.hpp"

#include <gtest/gtest.h>

#include "daemon/session/guidance.hpp"
#include "daemon/session/result_json.hpp"
#include "tests/unit/session/tracked_scene.hpp"

namespace handeye {
namespace {

using namespace tracked;

CalibrationOptions options() {
  CalibrationOptions options;
  options.start.request_id = 42;
  options.camera = kCamera;
  options.noise.hand_rotation_rad = rad_from_deg(0.06);
  return options;
}

CalibrationResult calibrate(double duration_s, bool with_hand = true, bool with_frames = true) {
  TrackedScene scene;
  Calibration calibration(options());
  for (int k = 0; with_hand && k < duration_s * kTrackerRate_hz; ++k) {
    calibration.add_hand(scene.hand(k));
  }
  for (int k = 0; with_frames && k < duration_s * kFrameRate_hz; ++k) {
    calibration.add_frame(scene.frame(k));
  }
  return calibration.solve();
}

TEST(Calibration, FindsTransformationAndTimeOffset) {
  const CalibrationResult result = calibrate(12);
  EXPECT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
  const Pose& found = result.solution.hand_from_eye;
  const Pose truth = true_hand_from_eye();
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found.linear(), truth.linear())), 0.1);
  EXPECT_LT((found.translation() - truth.translation()).norm(), 0.7);
  ASSERT_TRUE(result.time_offset_s);
  EXPECT_NEAR(*result.time_offset_s, kTimeOffset_s, 0.001);
  EXPECT_EQ(result.request_id, 42);
  EXPECT_EQ(result.frames.used, result.frames.received);
  EXPECT_EQ(result.method, "one_step");
  const auto table = methods(ScaleMode::kUnknown);
  ASSERT_EQ(result.methods.size(), table.size() + 1);
  EXPECT_EQ(result.methods.back().name, "one_step");
  for (const MethodResult& method : result.methods) {
    EXPECT_TRUE(method.solution && method.sigma) << method.name;
  }
}

TEST(Calibration, GivesTheSameAnswerTwice) {
  auto first = to_json(calibrate(6));
  auto second = to_json(calibrate(6));
  for (auto* json : {&first, &second}) {
    json->erase("timings_ms");
    for (auto& method : (*json)["methods"]) method.erase("time_ms");
  }
  EXPECT_EQ(first.dump(), second.dump());
}

TEST(Calibration, SaysWhichDeviceWasSilent) {
  EXPECT_EQ(calibrate(3, true, false).reason, Reason::kCameraLost);
  const CalibrationResult result = calibrate(3, false, true);
  EXPECT_EQ(result.reason, Reason::kTrackerLost);
  EXPECT_EQ(result.verdict, Verdict::kRefused);
  EXPECT_FALSE(result.has_estimate);
  EXPECT_GT(result.frames.used, 60) << "what was reconstructed is told all the same";
  EXPECT_EQ(calibrate(3, false, false).reason, Reason::kCameraLost);
}

TEST(Calibration, ProgressTellsSigmaAndGuidesTheHand) {
  TrackedScene scene;
  Calibration calibration(options());
  EXPECT_EQ(guidance_for(calibration.situation()).code, GuideCode::kNoImage);
  for (int k = 0; k < 8 * kTrackerRate_hz; ++k) calibration.add_hand(scene.hand(k));
  for (int k = 0; k < 8 * kFrameRate_hz; ++k) calibration.add_frame(scene.frame(k));
  const Situation situation = calibration.situation();
  EXPECT_GT(situation.keyframes, 5);
  EXPECT_GT(situation.rotation_coverage_deg, 15);
  const Provisional so_far = provisional(calibration.outline());
  ASSERT_TRUE(so_far.solution && so_far.sigma);
  EXPECT_GT(so_far.sigma->rotation_deg, 0);
  const Pose& found = so_far.solution->hand_from_eye;
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found.linear(), true_hand_from_eye().linear())),
            3.5 * so_far.sigma->rotation_deg);
  EXPECT_LT((found.translation() - true_hand_from_eye().translation()).norm(),
            3.5 * so_far.sigma->translation_mm);
  ASSERT_TRUE(so_far.time_offset_sigma_s);
  EXPECT_NEAR(so_far.time_offset_s, kTimeOffset_s, 0.003);
  EXPECT_GT(so_far.time_offset_confidence, 0);
  EXPECT_GT(so_far.turned_deg.head<2>().minCoeff(), 2);
  const bool wanted = so_far.sigma->rotation_deg <= 0.3 && so_far.sigma->translation_mm <= 1.5;
  EXPECT_EQ(guidance_for(situation, so_far).code == GuideCode::kNone, wanted);
}

TEST(Calibration, ClaimsNoSigmaThatLeavesTheLensOut) {
  TrackedScene scene;
  CalibrationOptions with_lens = options();
  with_lens.intrinsics = IntrinsicsMode::kRefine;
  Calibration calibration(with_lens);
  for (int k = 0; k < 8 * kTrackerRate_hz; ++k) calibration.add_hand(scene.hand(k));
  for (int k = 0; k < 8 * kFrameRate_hz; ++k) calibration.add_frame(scene.frame(k));
  const Provisional before = provisional(calibration.outline());
  EXPECT_FALSE(before.sigma);
  ASSERT_TRUE(before.sigma_beside_lens);
  const CalibrationResult result = calibration.solve();
  ASSERT_TRUE(result.lens && result.lens->observable);
  const Provisional after = provisional(calibration.outline());
  ASSERT_TRUE(after.sigma && after.sigma_beside_lens);
  EXPECT_GT(after.sigma->rotation_deg, after.sigma_beside_lens->rotation_deg);
  EXPECT_GT(after.sigma->translation_mm, after.sigma_beside_lens->translation_mm);
}

// Under a lens of a wrong focal length the eye seems to turn otherwise than the hand.
TEST(Calibration, BelievesNoLensThatTheHandContradicts) {
  TrackedScene scene;
  CalibrationOptions with_lens = options();
  with_lens.intrinsics = IntrinsicsMode::kRefine;
  Calibration calibration(with_lens);
  Eigen::Matrix3d first;
  for (int k = 0; k < 8 * kTrackerRate_hz; ++k) {
    HandSample sample = scene.hand(k);
    // Told to have turned a tenth more than it did.
    if (k == 0) first = sample.room_from_hand.linear();
    const Eigen::Vector3d turned = log_so3(sample.room_from_hand.linear() * first.transpose());
    sample.room_from_hand.linear() = exp_so3(1.1 * turned) * first;
    calibration.add_hand(sample);
  }
  for (int k = 0; k < 8 * kFrameRate_hz; ++k) calibration.add_frame(scene.frame(k));
  EXPECT_FALSE(provisional(calibration.outline()).sigma_beside_lens);
  const CalibrationResult result = calibration.solve();
  EXPECT_EQ(result.verdict, Verdict::kRefused);
  EXPECT_EQ(result.reason, Reason::kLensUnobservable) << reason_word(result.reason);
  ASSERT_TRUE(result.lens);
  EXPECT_FALSE(result.lens->observable);
}

}  // namespace
}  // namespace handeye
