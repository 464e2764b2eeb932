// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "daemon/handeye/residual_whitening.hpp"
#include "tests/unit/handeye/synthetic.hpp"

/// The likelihood's equation: its derivatives, and the noise it is whitened by.
namespace handeye {
namespace {

constexpr double kStep = 1e-6;

class Draw {
 public:
  explicit Draw(std::uint32_t seed) : generator_(seed) {}
  double normal() { return normal_(generator_); }
  Eigen::Vector3d normal3() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }
  Eigen::Quaterniond rotation() { return Eigen::Quaterniond(exp_so3(normal3())); }

 private:
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

CentredPose any_pose(Draw& draw) {
  return {draw.rotation(),      100 * draw.normal3(), draw.rotation(),
          100 * draw.normal3(), draw.normal3(),       50 * draw.normal3()};
}

PoseUnknowns any_unknowns(Draw& draw, double lever_arm_mm) {
  return {draw.rotation(),      lever_arm_mm * draw.normal3(), draw.rotation(),
          100 * draw.normal3(), 0.3 * draw.normal(),           0.01 * draw.normal()};
}

constexpr ResidualNoise::Variances kNoise{1e-6, 4e-7, 0.05, 0.3};

TEST(LikelihoodEquation, HasTheDerivativesOfItsDifferences) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Draw draw(seed);
    const CentredPose pose = any_pose(draw);
    const PoseUnknowns unknowns = any_unknowns(draw, seed % 5 == 0 ? 0.0 : 100.0);
    const auto whitened = [&](const PoseUnknowns& at) {
      return ResidualWhitening(kNoise, 0.1, at).value(pose_residual(pose, at));
    };
    PoseResidual residual = pose_residual_with_jacobian(pose, unknowns);
    ResidualWhitening(kNoise, 0.1, unknowns).apply(residual);
    EXPECT_TRUE(residual.value.isApprox(whitened(unknowns), 1e-12));
    for (int i = 0; i < kUnknowns; ++i) {
      const UnknownsVector step = kStep * UnknownsVector::Unit(i);
      const Vector6d difference =
          (whitened(unknowns.moved_by(step)) - whitened(unknowns.moved_by(-step))) / (2 * kStep);
      EXPECT_LT((residual.jacobian.col(i) - difference).norm(),
                1e-6 * (1 + residual.jacobian.norm()))
          << "unknown " << i << ", seed " << seed;
    }
  }
}

TEST(LikelihoodEquation, IsWhitenedAsItsCovarianceSays) {
  Draw draw(3);
  for (const double lever_arm_mm : {0.0, 20.0, 300.0}) {
    PoseUnknowns unknowns = any_unknowns(draw, lever_arm_mm);
    unknowns.log_scale = 0.1;
    const ResidualNoise noise(unknowns.eye_in_hand_mm);
    const Matrix6d inverse = noise.covariance(kNoise).inverse();
    Vector6d residual;
    residual << 1e-3 * draw.normal3(), draw.normal3();
    const double norm = ResidualWhitening(kNoise, 0.1, unknowns).value(residual).squaredNorm();
    EXPECT_NEAR(norm / residual.dot(inverse * residual), 1.0, 1e-9);
    EXPECT_NEAR((noise.whitening(kNoise) * residual).squaredNorm() / norm, 1.0, 1e-9);
  }
}

/// To first order: what the noise of hand and eye does to the residual is what the model says.
TEST(LikelihoodEquation, HasTheCovarianceOfSamples) {
  constexpr int kSamples = 20000;
  const synthetic::Truth truth = synthetic::scope();
  const PoseNoise noise{0.002, 0.15, 0.001, 0.1};
  const Pose room_from_eye = synthetic::free_hand(1.3);
  const Pose hand = room_from_eye * truth.solution.hand_from_eye.inverse();
  const Pose eye = truth.room_from_scene.inverse() * room_from_eye;
  PoseUnknowns unknowns;
  unknowns.hand_from_eye = Eigen::Quaterniond(truth.solution.hand_from_eye.linear());
  unknowns.eye_in_hand_mm = truth.solution.hand_from_eye.translation();
  unknowns.room_from_scene = Eigen::Quaterniond(truth.room_from_scene.linear());
  unknowns.scene_in_room_mm = truth.room_from_scene.translation();
  Draw draw(4);
  Matrix6d sum = Matrix6d::Zero();
  for (int k = 0; k < kSamples; ++k) {
    const CentredPose pose{
        Eigen::Quaterniond(hand.linear() * exp_so3(noise.hand_rotation_rad * draw.normal3())),
        hand.translation() + noise.hand_translation_mm * draw.normal3(),
        Eigen::Quaterniond(eye.linear() * exp_so3(noise.eye_rotation_rad * draw.normal3())),
        eye.translation() + noise.eye_translation_mm * draw.normal3(),
        Eigen::Vector3d::Zero(),
        Eigen::Vector3d::Zero()};
    const Vector6d whitened =
        ResidualWhitening(variances_of(noise), 0.0, unknowns).value(pose_residual(pose, unknowns));
    sum += whitened * whitened.transpose() / kSamples;
  }
  EXPECT_LT((sum - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace handeye
