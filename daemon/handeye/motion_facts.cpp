// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/motion_facts.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {

MotionFacts motion_facts(std::span<const Pose> a_from_body) {
  MotionFacts facts;
  if (a_from_body.empty()) return facts;
  const auto n = static_cast<double>(a_from_body.size());
  Eigen::Matrix3d mean_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_position = Eigen::Vector3d::Zero();
  for (const Pose& pose : a_from_body) {
    mean_matrix += pose.linear() / n;
    mean_position += pose.translation() / n;
  }

  const Eigen::Matrix3d mean_attitude = nearest_rotation(mean_matrix);
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean_turn = Eigen::Vector3d::Zero();
  // A fixed point q of the body: R_k q + t_k is the same for all k, so that, with the means taken
  // off, (R_k - mean R) q = -(t_k - mean t).
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double path_square = 0;
  for (const Pose& pose : a_from_body) {
    const Eigen::Vector3d turn = log_so3(mean_attitude.transpose() * pose.linear());
    turns += turn * turn.transpose() / n;
    mean_turn += turn / n;
    const Eigen::Matrix3d rows = pose.linear() - mean_matrix;
    const Eigen::Vector3d shift = pose.translation() - mean_position;
    normal += rows.transpose() * rows / n;
    right -= rows.transpose() * shift / n;
    path_square += shift.squaredNorm() / n;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(turns -
                                                             mean_turn * mean_turn.transpose());
  facts.principal_rotation_rad = eigen.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  facts.path_rms = std::sqrt(path_square);
  const Eigen::Vector3d fixed_point = normal.completeOrthogonalDecomposition().solve(right);
  facts.pivot_rms = std::sqrt(std::max(0.0, path_square - fixed_point.dot(right)));
  return facts;
}

Eigen::Vector3d turned_deg(std::span<const Pose> room_from_hand, const Pose& hand_from_eye) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Pose& pose : room_from_hand) sum += pose.linear();
  if (room_from_hand.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Matrix3d mean_attitude = nearest_rotation(sum);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const Pose& pose : room_from_hand) {
    const Eigen::Vector3d turn = log_so3(mean_attitude.transpose() * pose.linear());
    squares += (hand_from_eye.linear().transpose() * turn).cwiseAbs2();
  }
  const Eigen::Vector3d rms = (squares / static_cast<double>(room_from_hand.size())).cwiseSqrt();
  return rms.unaryExpr([](double angle_rad) { return deg_from_rad(angle_rad); });
}

}  // namespace handeye
