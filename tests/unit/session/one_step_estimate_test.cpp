// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/one_step_estimate.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/session/calibration.hpp"
#include "daemon/session/one_step_problem.hpp"
#include "tests/unit/session/tracked_scene.hpp"

/// The answer in one step, from what a session has.
namespace handeye {
namespace {

constexpr double kDuration_s = 8;
constexpr double kRotation_deg = 0.06;  // of tracked::TrackedScene's hand
constexpr double kTranslation_mm = 0.15;

/// What the tracker says of its noise, as a factor of what is true; 0: nothing.
CalibrationSnapshot snapshot_of(double claimed, HandNoiseSource source) {
  CalibrationOptions options{.camera = tracked::kCamera, .reconstruction = {}};
  options.hand_noise = source;
  Calibration calibration(options);
  tracked::TrackedScene scene;
  Eigen::Matrix<float, 6, 1> variances;
  variances << Eigen::Vector3f::Constant(
      static_cast<float>(std::pow(claimed * rad_from_deg(kRotation_deg), 2))),
      Eigen::Vector3f::Constant(static_cast<float>(std::pow(claimed * kTranslation_mm, 2)));
  for (int k = 0; k < kDuration_s * tracked::kTrackerRate_hz; ++k) {
    HandSample sample = scene.hand(k);
    if (claimed > 0) sample.covariance = Eigen::Matrix<float, 6, 6>(variances.asDiagonal());
    calibration.add_hand(sample);
  }
  for (int k = 0; k < kDuration_s * tracked::kFrameRate_hz; ++k) {
    calibration.add_frame(scene.frame(k));
  }
  return calibration.snapshot();
}

Estimate estimate_of(const CalibrationSnapshot& snapshot) {
  return estimate(snapshot.reconstruction.frames, snapshot.hand, snapshot.options.noise);
}

TEST(OneStepProblem, HasEveryFrameAndPointAndTheHandAtItsTime) {
  const CalibrationSnapshot snapshot = snapshot_of(1, HandNoiseSource::kMeasured);
  const Reconstruction& seen = snapshot.reconstruction;
  const OneStepProblem problem =
      one_step_problem(seen, smoothed_for(seen.frames, snapshot.hand), tracked::kTimeOffset_s);
  ASSERT_EQ(problem.frames.size(), seen.frames.size());
  ASSERT_EQ(problem.points.size(), seen.structure.size());
  EXPECT_EQ(problem.camera.fx, tracked::kCamera.fx);
  std::size_t with_hand = 0;
  for (std::size_t i = 0; i < problem.frames.size(); ++i) {
    const OneStepFrame& frame = problem.frames[i];
    EXPECT_EQ(frame.keyframe, seen.frames[i].keyframe);
    EXPECT_EQ(frame.eye_from_scene.matrix(), seen.frames[i].eye_from_scene.matrix());
    if (!frame.hand) continue;
    ++with_hand;
    EXPECT_TRUE(frame.hand->sample_covariance);
    const double time_s =
        1e-9 * static_cast<double>(seen.frames[i].timestamp_ns - tracked::kStart_ns) -
        tracked::kTimeOffset_s;
    const Pose expected = tracked::free_motion(time_s) * tracked::true_hand_from_eye().inverse();
    EXPECT_LT((frame.hand->room_from_hand.translation() - expected.translation()).norm(), 1.0);
  }
  EXPECT_GT(with_hand, problem.frames.size() - 5) << "but for those at the ends";
}

TEST(OneStepProblem, LetsNoFrameCountOfWhichNothingIsKnown) {
  CalibrationSnapshot snapshot = snapshot_of(0, HandNoiseSource::kEstimated);
  auto& frames = snapshot.reconstruction.frames;
  const auto between = std::ranges::find(frames, false, &RegisteredFrame::keyframe);
  ASSERT_NE(between, frames.end());
  between->unit_covariance.setZero();
  const OneStepProblem problem = one_step_problem(
      snapshot.reconstruction, smoothed_for(snapshot.reconstruction.frames, snapshot.hand),
      tracked::kTimeOffset_s);
  EXPECT_FALSE(problem.frames[static_cast<std::size_t>(between - frames.begin())].hand);
}

TEST(OneStepProblem, CountsAPointOnceInAFrameThatSawItTwice) {
  CalibrationSnapshot snapshot = snapshot_of(0, HandNoiseSource::kEstimated);
  const Estimate start = estimate_of(snapshot);
  const auto wanted = estimate_in_one_step(snapshot.reconstruction, snapshot.hand, start,
                                           HandNoiseSource::kEstimated);
  for (ScenePoint& point : snapshot.reconstruction.structure) {
    point.observations.insert(point.observations.begin() + 1, point.observations.front());
    point.observations[1].pixel.x() += 3;
    point.observations.push_back(point.observations.front());
  }
  const auto found = estimate_in_one_step(snapshot.reconstruction, snapshot.hand, start,
                                          HandNoiseSource::kEstimated);
  ASSERT_TRUE(wanted && found);
  EXPECT_EQ(found->result.hand_from_eye.matrix(), wanted->result.hand_from_eye.matrix());
}

/// Against the noise that the likelihood found: what "twice the noise" is counted from.
TEST(OneStepEstimate, LeavesWhatTheLikelihoodLeft) {
  const CalibrationSnapshot snapshot = snapshot_of(0, HandNoiseSource::kEstimated);
  const auto found = estimate_in_one_step(snapshot.reconstruction, snapshot.hand,
                                          estimate_of(snapshot), HandNoiseSource::kEstimated);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->result.chi2_per_dof, 1, 0.2);
}

TEST(OneStepEstimate, WeighsByTheTrackersWordOnlyWhereThereIsOneThatHolds) {
  struct Case {
    double claimed;
    HandNoiseSource wanted;
    const char* source;
  };
  for (const Case& one : {Case{1, HandNoiseSource::kMeasured, "measured"},
                          Case{0, HandNoiseSource::kMeasured, "estimated"},
                          Case{0.1, HandNoiseSource::kMeasured, "estimated"},
                          Case{1, HandNoiseSource::kEstimated, "estimated"},
                          Case{0.1, HandNoiseSource::kGiven, "given"}}) {
    const CalibrationResult result = solve(snapshot_of(one.claimed, one.wanted)).result;
    ASSERT_EQ(result.method, "one_step") << one.source;
    ASSERT_TRUE(result.hand_noise);
    EXPECT_EQ(result.hand_noise->source, one.source) << one.claimed;
    EXPECT_NEAR(result.hand_noise->rotation_deg, kRotation_deg, 0.01) << one.source;
    EXPECT_NEAR(result.hand_noise->translation_mm, kTranslation_mm, 0.03) << one.source;
    EXPECT_GT(result.image_noise_px, 0);
    const Vector6d error = [&] {
      const Pose truth = tracked::true_hand_from_eye();
      const Pose& found = result.solution.hand_from_eye;
      Vector6d both;
      both << log_so3(found.linear() * truth.linear().transpose()),
          found.translation() - truth.translation();
      return both;
    }();
    // 99.99 % of chi2 with 6 degrees of freedom.
    EXPECT_LT(error.dot(result.covariance.ldlt().solve(error)), 27.9) << one.source;
  }
}

/// The likelihood's answer stands where one step would have to start from nothing it can use.
TEST(OneStepEstimate, LeavesTheAnswerToTheLikelihoodWithoutAStructure) {
  CalibrationSnapshot snapshot = snapshot_of(0, HandNoiseSource::kEstimated);
  snapshot.reconstruction.structure.clear();
  const CalibrationResult result = solve(snapshot).result;
  EXPECT_EQ(result.method, "maximum_likelihood");
  EXPECT_EQ(result.methods.back().name, "maximum_likelihood");
  EXPECT_TRUE(result.has_estimate);
  EXPECT_EQ(result.image_noise_px, 0);
}

}  // namespace
}  // namespace handeye
