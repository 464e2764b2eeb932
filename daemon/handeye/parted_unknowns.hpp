// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "daemon/handeye/pose_residual.hpp"

/// The unknowns of several parts: hand_from_eye and the time offset are common, room_from_scene and
/// the scale each part's own.
namespace handeye {

using PartedVector = Eigen::VectorXd;
using PartedMatrix = Eigen::MatrixXd;

inline constexpr int kOwnUnknowns = kTimeOffset - kSceneTurn;  ///< of a part: 7

constexpr bool is_common(int unknown) {
  return unknown < kSceneTurn || unknown == kTimeOffset;
}

/// Where an unknown of the equation of a pose of `part` stands among all: those of the first part
/// as they do in the equation, then the other parts' own.
constexpr Eigen::Index index_of(int unknown, std::size_t part) {
  if (part == 0 || is_common(unknown)) return unknown;
  return kUnknowns + kOwnUnknowns * static_cast<Eigen::Index>(part - 1) + (unknown - kSceneTurn);
}

constexpr Eigen::Index unknowns_of_parts(std::size_t parts) {
  return kUnknowns + kOwnUnknowns * static_cast<Eigen::Index>(parts - 1);
}

/// Of the unknowns of all, those in the equation of a pose of `part`.
UnknownsVector of_part(const PartedVector& all, std::size_t part);

/// Adds what the poses of `part` say to what all say. In the sum over parts only the blocks of the
/// common unknowns, and those between them and one part's own, are filled: an arrow.
void add_part(const UnknownsVector& own, std::size_t part, PartedVector& all);
void add_part(const UnknownsMatrix& own, std::size_t part, PartedMatrix& all);

/// Inner product, the first part's unknowns apart: they are all there is in most cases, and of
/// fixed size.
inline double dot(const PartedVector& a, const PartedVector& b) {
  const Eigen::Index others = a.size() - kUnknowns;
  return a.head<kUnknowns>().dot(b.head<kUnknowns>()) + a.tail(others).dot(b.tail(others));
}

/// One PoseUnknowns a part; what is common is the same in all.
class PartedUnknowns {
 public:
  explicit PartedUnknowns(std::vector<PoseUnknowns> of_parts) : of_parts_(std::move(of_parts)) {}

  const PoseUnknowns& of(std::size_t part) const { return of_parts_[part]; }
  const PoseUnknowns& common() const { return of_parts_.front(); }
  std::size_t parts() const { return of_parts_.size(); }

  PartedUnknowns moved_by(const PartedVector& step) const;
  void set_log_scale(std::size_t part, double log_scale) { of_parts_[part].log_scale = log_scale; }

 private:
  std::vector<PoseUnknowns> of_parts_;
};

}  // namespace handeye
