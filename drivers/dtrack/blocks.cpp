// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/blocks.hpp"

#include <algorithm>
#include <array>

namespace handeye::dtrack {

bool read_position(Scanner& line, Eigen::Vector3d& position_mm) {
  return line.read_block({position_mm.data(), 3});
}

bool read_position_and_angles(Scanner& line, Eigen::Vector3d& position_mm) {
  std::array<double, 6> values;
  if (!line.read_block(values)) return false;
  std::copy_n(values.begin(), 3, position_mm.data());
  return true;
}

bool read_matrix(Scanner& line, Eigen::Matrix3d& matrix) {
  static_assert(!Eigen::Matrix3d::IsRowMajor, "the wire runs through columns");
  return line.read_block({matrix.data(), 9});
}

bool make_pose_of_printed(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& position_mm,
                          Pose& pose) {
  const Eigen::Matrix3d gram = matrix.transpose() * matrix;
  const double deviation = (gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kRotationTolerance) || matrix.determinant() < 0) return false;
  // One Newton step towards the orthogonal factor of the polar decomposition: R (3 I - R'R) / 2.
  pose.linear().noalias() = matrix * (1.5 * Eigen::Matrix3d::Identity() - 0.5 * gram);
  pose.translation() = position_mm;
  return true;
}

}  // namespace handeye::dtrack
