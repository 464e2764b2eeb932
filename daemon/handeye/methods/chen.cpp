// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"
#include "daemon/handeye/movements.hpp"

// Chen 1991, "A screw motion approach to uniqueness analysis of head-eye geometry": a movement is a
// screw, a turn about and a shift along one line. X carries the hand's line (direction l_H, moment
// m_H) to the eye's: l_E = R_X l_H and m_E = R_X m_H + t_X x l_E. Angle and shift along the line
// are the same on both sides and say nothing of X. All lines count the same, as printed.
namespace handeye {
namespace {

constexpr double kSmallestHalfSine = 1e-9;  // below it a movement has no line

/// Pluecker coordinates of a screw's line.
struct Line {
  Eigen::Vector3d direction;
  Eigen::Vector3d moment;
};

Line screw_line(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) {
  const double sine = q.vec().norm();
  const Eigen::Vector3d direction = q.vec() / sine;
  const Eigen::Vector3d across = t.cross(direction);
  return {direction, 0.5 * (across + q.w() / sine * direction.cross(across))};
}

struct LinePair {
  Line hand;
  Line eye;
};

std::vector<LinePair> line_pairs(std::span<const Movement> movements,
                                 const Eigen::Quaterniond& about) {
  std::vector<LinePair> lines;
  lines.reserve(movements.size());
  for (const Movement& movement : movements) {
    const auto [hand, eye] = signed_quaternions(movement, about);
    if (!(std::min(hand.vec().norm(), eye.vec().norm()) > kSmallestHalfSine)) continue;
    lines.push_back({screw_line(hand, movement.hand_j_from_hand_i.translation()),
                     screw_line(eye, movement.eye_j_from_eye_i.translation())});
  }
  return lines;
}

std::optional<Eigen::Matrix3d> rotation_of(const std::vector<LinePair>& lines) {
  std::vector<VectorPair> directions;
  directions.reserve(lines.size());
  for (const auto& [hand, eye] : lines) directions.push_back({hand.direction, eye.direction});
  return rotation_between(directions);
}

std::optional<Eigen::VectorXd> translation_of_lines(const std::vector<LinePair>& lines,
                                                    const Eigen::Matrix3d& rotation) {
  const auto n = static_cast<Eigen::Index>(lines.size());
  Eigen::MatrixXd matrix(3 * n, 3);
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& [hand, eye] = lines[static_cast<std::size_t>(k)];
    matrix.middleRows<3>(3 * k) = -skew(eye.direction);
    right.segment<3>(3 * k) = eye.moment - rotation * hand.moment;
  }
  return least_squares(matrix, right);
}

}  // namespace

std::optional<HandEyeSolution> chen(const HandEyeProblem& problem) {
  const auto normalised = normalise(problem.movements, ScaleMode::kKnown);
  if (!normalised) return std::nullopt;
  const auto about = eye_from_hand_rotation(normalised->movements);
  if (!about) return std::nullopt;
  const std::vector<LinePair> lines = line_pairs(normalised->movements, Eigen::Quaterniond(*about));
  if (lines.size() < 2) return std::nullopt;
  const auto rotation = rotation_of(lines);
  if (!rotation) return std::nullopt;
  const auto translation = translation_of_lines(lines, *rotation);
  if (!translation) return std::nullopt;
  Pose eye_from_hand = Pose::Identity();
  eye_from_hand.linear() = *rotation;
  eye_from_hand.translation() = *translation;
  return normalised->restore(eye_from_hand, 1.0);
}

}  // namespace handeye
