// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/movements_within_parts.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/parts.hpp"
#include "daemon/handeye/selection.hpp"

namespace handeye {
namespace {

std::vector<Movement> joined(const std::vector<std::vector<Movement>>& of_parts) {
  std::vector<Movement> all;
  for (const std::vector<Movement>& movements : of_parts) {
    all.insert(all.end(), movements.begin(), movements.end());
  }
  return all;
}

/// mm per scene unit of each part from (I - R_E) t_X - m_p t_E = -R_X t_H: eq 6 with t_X in mm, so
/// that all parts share it. Nothing where they are not determined or not positive.
std::optional<Eigen::VectorXd> mm_per_unit(const std::vector<std::vector<Movement>>& of_parts,
                                           const Eigen::Matrix3d& eye_from_hand) {
  const auto parts = static_cast<Eigen::Index>(of_parts.size());
  const auto count = static_cast<Eigen::Index>(joined(of_parts).size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3 * count, 3 + parts);
  Eigen::VectorXd right(3 * count);
  Eigen::Index row = 0;
  for (Eigen::Index p = 0; p < parts; ++p) {
    for (const auto& [hand, eye] : of_parts[static_cast<std::size_t>(p)]) {
      rows.block<3, 3>(row, 0) = Eigen::Matrix3d::Identity() - eye.linear();
      rows.block<3, 1>(row, 3 + p) = -eye.translation();
      right.segment<3>(row) = -(eye_from_hand * hand.translation());
      row += 3;
    }
  }
  const auto solution = least_squares(rows, right);
  if (!solution || !(solution->tail(parts).minCoeff() > 0)) return std::nullopt;
  return solution->tail(parts);
}

/// By the lengths of the paths of hand and eye, which a long lever makes differ.
Eigen::VectorXd mm_per_unit_of_paths(const std::vector<std::vector<Movement>>& of_parts) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(of_parts.size()));
  for (std::size_t p = 0; p < of_parts.size(); ++p) {
    double hand_square = 0;
    double eye_square = 0;
    for (const auto& [hand, eye] : of_parts[p]) {
      hand_square += hand.translation().squaredNorm();
      eye_square += eye.translation().squaredNorm();
    }
    const double ratio = std::sqrt(hand_square / eye_square);
    result[static_cast<Eigen::Index>(p)] = std::isnormal(ratio) ? ratio : 1.0;
  }
  return result;
}

}  // namespace

MovementsOfParts movements_within_parts(std::span<const HandEyeObservation> observations,
                                        ScaleMode scale) {
  std::vector<std::vector<Movement>> of_parts;
  std::size_t unit_part = 0;
  const std::vector<Part> parts = parts_of(observations);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (p > 0 && parts[p].members.size() < kFewestPosesOfPart) continue;
    auto movements = select_movements(poses_of(observations, parts[p]), {.scale = scale}).movements;
    if (movements.empty()) continue;
    if (of_parts.empty()) unit_part = p;
    of_parts.push_back(std::move(movements));
  }
  if (of_parts.size() < 2 || scale == ScaleMode::kKnown) return {joined(of_parts), unit_part};
  const auto rotation = eye_from_hand_rotation(joined(of_parts));
  if (!rotation) return {joined(of_parts), unit_part};
  const Eigen::VectorXd mm =
      mm_per_unit(of_parts, *rotation).value_or(mm_per_unit_of_paths(of_parts));
  for (std::size_t p = 1; p < of_parts.size(); ++p) {
    const double to_first = mm[static_cast<Eigen::Index>(p)] / mm[0];
    for (Movement& movement : of_parts[p]) movement.eye_j_from_eye_i.translation() *= to_first;
  }
  return {joined(of_parts), unit_part};
}

}  // namespace handeye
