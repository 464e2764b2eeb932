// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/usable.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr double kRounding = 1e-5;  // of R^T R - 1: five digits

}  // namespace

bool is_usable(const Pose& pose) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d rotation = pose.linear();
  return (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < kRounding &&
         rotation.determinant() > 0;
}

bool is_usable(const HandEyeSolution& solution) {
  return is_usable(solution.hand_from_eye) && std::isnormal(solution.scale_units_per_mm) &&
         solution.scale_units_per_mm > 0;
}

bool are_usable(std::span<const PosePair> poses) {
  return std::all_of(poses.begin(), poses.end(), [](const PosePair& pair) {
    return is_usable(pair.room_from_hand) && is_usable(pair.eye_from_scene);
  });
}

}  // namespace handeye
