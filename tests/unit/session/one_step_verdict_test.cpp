// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "daemon/session/calibration.hpp"
#include "daemon/session/offset_check.hpp"
#include "daemon/session/one_step_check.hpp"
#include "daemon/session/verdict.hpp"
#include "tests/unit/session/tracked_scene.hpp"

/// Which answers in one step are believed.
namespace handeye {
namespace {

constexpr double kDuration_s = 8;

const CalibrationSnapshot& snapshot() {
  static const CalibrationSnapshot taken = [] {
    Calibration calibration({.camera = tracked::kCamera, .reconstruction = {}});
    tracked::TrackedScene scene;
    for (int k = 0; k < kDuration_s * tracked::kTrackerRate_hz; ++k) {
      calibration.add_hand(scene.hand(k));
    }
    for (int k = 0; k < kDuration_s * tracked::kFrameRate_hz; ++k) {
      calibration.add_frame(scene.frame(k));
    }
    return calibration.snapshot();
  }();
  return taken;
}

/// The likelihood's answer and the one in one step, to be tampered with.
class OneStepVerdict : public testing::Test {
 protected:
  void SetUp() override {
    start = estimate(snapshot().reconstruction.frames, snapshot().hand, snapshot().options.noise);
    one_step = estimate_in_one_step(snapshot().reconstruction, snapshot().hand, start,
                                    HandNoiseSource::kEstimated);
    ASSERT_TRUE(start.likelihood && one_step);
  }

  Finding concluded() const {
    return conclude({.frames_received = snapshot().begun.frames.received,
                     .images = snapshot().images,
                     .hand_path = snapshot().hand_path,
                     .reconstruction = snapshot().reconstruction,
                     .estimate = start,
                     .one_step = one_step,
                     .noise = snapshot().options.noise,
                     .wanted = {}});
  }

  void move_answer(double turn_deg, double shift_mm) {
    Pose& answer = one_step->result.hand_from_eye;
    answer.linear() = exp_so3({0, rad_from_deg(turn_deg), 0}) * answer.linear();
    answer.translation().z() += shift_mm;
    one_step->solution.hand_from_eye = answer;
  }

  Estimate start;
  std::optional<OneStepEstimate> one_step;
};

TEST_F(OneStepVerdict, AcceptsAsMuchAsIsKnown) {
  const Finding finding = concluded();
  EXPECT_EQ(finding.reason, Reason::kNone);
  EXPECT_LT(sigma_rotation_deg(finding.covariance), 0.1);
  EXPECT_LT(sigma_translation_mm(finding.covariance), 0.5);
}

/// However sure it is of itself, and however well halves that start from it come back to the truth.
TEST_F(OneStepVerdict, NeverAcceptsAWrongMinimum) {
  struct Case {
    double turn_deg, shift_mm;
  };
  for (const Case& wrong : {Case{1, 0}, Case{0, 5}, Case{20, 100}}) {
    SetUp();
    move_answer(wrong.turn_deg, wrong.shift_mm);
    one_step->result.covariance *= 0.1;
    const Finding finding = concluded();
    EXPECT_EQ(finding.reason, Reason::kUncertain) << wrong.turn_deg << ' ' << wrong.shift_mm;
    EXPECT_GT(sigma_rotation_deg(finding.covariance), 0.8 * wrong.turn_deg);
    EXPECT_GT(sigma_translation_mm(finding.covariance), 0.8 * wrong.shift_mm);
  }
}

TEST_F(OneStepVerdict, IsByHalvesOfItsOwn) {
  const auto halves =
      compare_halves(one_step->problem, one_step->start, one_step->result, one_step->options);
  ASSERT_TRUE(halves);
  const Finding finding = concluded();
  ASSERT_TRUE(finding.judgement && finding.judgement->halves_chi2);
  EXPECT_EQ(*finding.judgement->halves_chi2, halves->chi2);
}

TEST_F(OneStepVerdict, RefusesWhatTakesAMuchWorseTracker) {
  one_step->result.hand_rotation_sigma_rad = 6 * snapshot().options.noise.hand_rotation_rad;
  EXPECT_EQ(concluded().reason, Reason::kUncertain);
  one_step->hand_noise = HandNoiseSource::kMeasured;
  EXPECT_EQ(concluded().reason, Reason::kNone) << "the tracker says so itself";
  SetUp();
  one_step->result.hand_translation_sigma_mm = 6 * snapshot().options.noise.hand_translation_mm;
  EXPECT_EQ(concluded().reason, Reason::kUncertain);
}

TEST_F(OneStepVerdict, LeavesAWorseFitThanTheLikelihoods) {
  const PoseNoise& noise = start.likelihood->noise;
  const auto explains = [&] {
    return explains_the_hand(one_step->result, one_step->problem, one_step->options, noise);
  };
  EXPECT_TRUE(explains());
  one_step->result.chi2_per_dof = 4.1;
  EXPECT_FALSE(explains());
  // Given a quarter of the noise that the likelihood sees, sixteen times the chi2 is no surprise.
  one_step->options.hand_rotation_sigma_rad /= 4;
  one_step->options.hand_translation_sigma_mm /= 4;
  EXPECT_TRUE(explains());
  one_step->result.chi2_per_dof = 1;
  one_step->result.rejected.resize(one_step->problem.frames.size() / 4);
  EXPECT_FALSE(explains()) << "chi2 is of the hands that were kept";
}

TEST(OffsetCheck, FindsAJumpOfTheCamerasStamps) {
  CalibrationSnapshot jumped = snapshot();
  auto& frames = jumped.reconstruction.frames;
  EXPECT_FALSE(offset_jumped(frames, jumped.hand));
  for (std::size_t k = frames.size() / 2; k < frames.size(); ++k) {
    frames[k].timestamp_ns += 100'000'000;
  }
  EXPECT_TRUE(offset_jumped(frames, jumped.hand));
  EXPECT_EQ(solve(jumped).result.reason, Reason::kClockUnstable);
}

}  // namespace
}  // namespace handeye
