// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/unit/handeye/one_step_scenes.hpp"

/// An answer is a minimum, or it is none.
namespace handeye {
namespace {

class OneStepMinimum : public ::testing::Test {
 protected:
  std::optional<OneStepResult> solve(const MaximumLikelihoodResult& start) const {
    return one_step(scene_.problem, start, options_);
  }
  /// The start with its scene larger, and turned and shifted against the hand.
  MaximumLikelihoodResult elsewhere(double times) const {
    MaximumLikelihoodResult start = start_;
    for (PartResult& part : start.parts) part.scale_units_per_mm /= times;
    start.solution.hand_from_eye.translation() += Eigen::Vector3d(4, -3, 5);
    start.solution.hand_from_eye.linear() =
        exp_so3(Eigen::Vector3d(0.01, 0.02, -0.01)) * start.solution.hand_from_eye.linear();
    return start;
  }

  synthetic::OneStepScene scene_ = synthetic::one_step_scene({}, 2);
  MaximumLikelihoodResult start_ = *synthetic::start_of(scene_);
  OneStepOptions options_ = synthetic::one_step_options(scene_, HandNoiseSource::kEstimated);
};

TEST_F(OneStepMinimum, IsTheSameFromWhereverItIsFound) {
  const auto near = solve(start_);
  ASSERT_TRUE(near);
  for (const double times : {0.95, 1.05}) {
    const auto far = solve(elsewhere(times));
    ASSERT_TRUE(far) << times;
    const Vector6d apart = synthetic::error_of(far->hand_from_eye, near->hand_from_eye);
    EXPECT_LT(apart.dot(near->covariance.ldlt().solve(apart)), 0.1 * 0.1) << times;
  }
}

TEST_F(OneStepMinimum, ThatIsNotReachedIsNoAnswer) {
  options_.max_iterations = 1;
  options_.noise_rounds = 1;
  EXPECT_TRUE(solve(start_));
  EXPECT_FALSE(solve(elsewhere(1.6)));
}

}  // namespace
}  // namespace handeye
