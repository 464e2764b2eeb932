// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/sight.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace handeye {
namespace {

/// Of what a keyframe's images say: so little that points are without freedom for nothing.
constexpr double kLeastOfPoints = 1e-9;

constexpr Eigen::Index kPanel = 48;  // columns: keyframes by sixes that stay in the cache

/// L^-1 right, block-diagonal but for the lens's columns at the end: above its block a column stays
/// zero, a third of the work.
void solve_block_diagonal(const Eigen::MatrixXd& lower, Eigen::MatrixXd& right) {
  const Eigen::Index n = lower.rows();
  for (Eigen::Index at = 0; at < n; at += kPanel) {
    const Eigen::Index rest = n - at;
    auto panel = right.block(at, at, rest, std::min(kPanel, rest));
    lower.bottomRightCorner(rest, rest).triangularView<Eigen::Lower>().solveInPlace(panel);
  }
  auto of_lens = right.rightCols<kLensParameters>();
  lower.triangularView<Eigen::Lower>().solveInPlace(of_lens);
}

}  // namespace

std::vector<Pose> keyframes_by_sight(const MetricScene& scene, const MetricState& state,
                                     const ImageRows& rows) {
  std::vector<Matrix6d> information(scene.keyframes(), Matrix6d::Zero());
  std::vector<Vector6d> gradient(scene.keyframes(), Vector6d::Zero());
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    const ImageRow& row = rows.rows[i];
    const std::size_t k = scene.observations[i].keyframe;
    const Matrix26 eye = pixel_by_eye(row);
    information[k].noalias() += eye.transpose() * eye;
    gradient[k].noalias() += eye.transpose() * row.error;
  }
  std::vector<Pose> poses;
  poses.reserve(scene.keyframes());
  for (std::size_t k = 0; k < scene.keyframes(); ++k) {
    const Vector6d step = information[k].llt().solve(gradient[k]);
    Pose& pose = poses.emplace_back(state.room_from_eye[k]);
    if (!step.allFinite()) continue;
    pose.linear() = exp_so3(-step.head<3>()) * pose.linear();
    pose.translation() -= step.tail<3>();
  }
  return poses;
}

void Sight::linearise(const PointElimination& elimination) {
  const Eigen::MatrixXd& eliminated = elimination.information();
  const Eigen::Index eyes = scene_.common_at();
  of_eyes_ = elimination.information_of_eyes();
  of_lens_ = eliminated.bottomLeftCorner(kLensParameters, eyes).transpose();
  Eigen::MatrixXd of_points = -eliminated.topLeftCorner(eyes, eyes);
  Eigen::MatrixXd rooted = Eigen::MatrixXd::Zero(eyes, eyes + kCommonUnknowns);
  for (std::size_t k = 0; k < scene_.keyframes(); ++k) {
    const Eigen::Index at = unknowns_of_eye(k);
    of_points.block<6, 6>(at, at) += of_eyes_[k];
    of_points.diagonal().segment<6>(at) += kLeastOfPoints * of_eyes_[k].diagonal();
    rooted.block<6, 6>(at, at) = of_eyes_[k];
  }
  rooted.rightCols<kLensParameters>() = of_lens_;
  of_points_.compute(of_points);
  solve_block_diagonal(of_points_.matrixLLT(), rooted);
  information_.setZero(scene_.unknowns(), scene_.unknowns());
  const auto by_lens = rooted.rightCols<kLensParameters>();
  information_.bottomRightCorner<kLensParameters, kLensParameters>() =
      eliminated.bottomRightCorner<kLensParameters, kLensParameters>() +
      by_lens.transpose() * by_lens;
  information_.bottomLeftCorner(kLensParameters, eyes) =
      by_lens.transpose() * rooted.leftCols(eyes);
  for (Eigen::Index at = 0; at < eyes; at += kPanel) {
    const Eigen::Index width = std::min(kPanel, eyes - at);
    information_.block(at, 0, width, at + width).noalias() =
        rooted.block(at, at, eyes - at, width).transpose() *
        rooted.block(at, 0, eyes - at, at + width);
  }
}

Eigen::MatrixXd Sight::keyframes_for_points(const Eigen::MatrixXd& steps) const {
  Eigen::MatrixXd right = of_lens_ * steps.bottomRows<kLensParameters>();
  for (std::size_t k = 0; k < scene_.keyframes(); ++k) {
    right.middleRows<6>(unknowns_of_eye(k)) +=
        of_eyes_[k] * steps.middleRows<6>(unknowns_of_eye(k));
  }
  return of_points_.solve(right);
}

Sight::Pull Sight::pull(const Eigen::VectorXd& taken_from_keyframes) const {
  Pull pull;
  pull.for_points = -of_points_.solve(taken_from_keyframes);
  pull.cost = 0.5 * taken_from_keyframes.dot(pull.for_points);
  pull.gradient.setZero(scene_.unknowns());
  for (std::size_t k = 0; k < scene_.keyframes(); ++k) {
    const Eigen::Index at = unknowns_of_eye(k);
    pull.gradient.segment<6>(at) = of_eyes_[k] * pull.for_points.segment<6>(at);
  }
  pull.gradient.tail<kLensParameters>() = of_lens_.transpose() * pull.for_points;
  return pull;
}

}  // namespace handeye
