// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// The unknowns of eq 7, X = eye_from_hand.
struct QuaternionUnknowns {
  Eigen::Quaterniond q{
      Eigen::Quaterniond::Identity()};         ///< of R_X; of unit norm but for the penalty
  Eigen::Vector3d t{Eigen::Vector3d::Zero()};  ///< t_X in the eye's units
  double s{1};                                 ///< the eye's units per mm
};

struct QuaternionOptions {
  bool free_scale{true};  ///< else s stays as it is: Horaud and Dornaika's function
  /// How |q| is kept at 1: by the printed penalty, or by moving q on the unit sphere alone.
  enum class UnitNorm { kPenalty, kManifold } unit_norm{UnitNorm::kPenalty};
};

/// Schmidt 2005, eq 7, as printed:
///   f(q, t, s) = sum |q q_H - q_E q|^2 + sum |Q((I - R_E) t - t_E) + q Q(s t_H) q*|^2
///              + lambda (1 - q* q)^2,  lambda = 2e6.
/// With s = 1 fixed it is the non-linear method of Horaud and Dornaika 1995 ("Hand-eye
/// calibration") as the seed gives it. There |q|^2 acts as a scale that lambda alone holds at 1;
/// with s free it does not. It adds rad^2 to the square of the eye's unit: give the eye in mm.
class QuaternionObjective {
 public:
  /// `about`: near R_X; settles the signs of the movements' quaternions near 180 degrees.
  QuaternionObjective(std::span<const Movement> movements, const Eigen::Quaterniond& about);

  double value(const QuaternionUnknowns& x) const;

  /// The minimum next to `start`, whose s is positive; nothing when there is none.
  std::optional<QuaternionUnknowns> minimise(const QuaternionUnknowns& start,
                                             const QuaternionOptions& options = {}) const;

  /// What a movement adds to the two sums, as triangles: rotation on q (w first); translation on
  /// (s M by rows, t, 1), where M v is the vector of q Q(v) q*.
  struct Folded {
    Eigen::Matrix4d rotation;
    Eigen::Matrix<double, 13, 13> translation;
  };

 private:
  Folded folded_;
};

/// hand_from_eye by the function of Horaud and Dornaika, from `start`; the eye in mm.
std::optional<Pose> horaud_hand_from_eye(std::span<const Movement> metric, const Pose& start);

}  // namespace handeye
