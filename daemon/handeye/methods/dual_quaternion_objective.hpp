// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// A similarity as a dual quaternion that is not of unit norm (Schmidt 2005, eq 9): real = s q,
/// dual = (1/2) Q(t) q, with q and t of X = eye_from_hand, t in the eye's units and s in its units
/// per mm.
struct SimilarityDualQuaternion {
  Eigen::Quaterniond real{Eigen::Quaterniond::Identity()};
  Eigen::Quaterniond dual{0, 0, 0, 0};

  static SimilarityDualQuaternion from(const Eigen::Quaterniond& q, const Eigen::Vector3d& t,
                                       double s);
  Eigen::Quaterniond q() const;
  Eigen::Vector3d t() const;
  double s() const;  ///< eq 11
};

/// Eqs 13 and 14 of one movement, right side subtracted from the left, on (real, dual, real / s),
/// each w first: q_E q_s - q_s q_H and q_E q_sd + (1/s) q_Ed q_s - q_s q_Hd - q_sd q_H.
Eigen::Matrix<double, 8, 12> similarity_rows(const Movement& movement,
                                             const Eigen::Quaterniond& about);

struct DualQuaternionOptions {
  /// How eq 12, (real, dual) orthogonal, is kept: by the printed penalty on eight unknowns, or by
  /// seven unknowns (q on the unit sphere, t, s) that cannot break it.
  enum class Constraint { kPenalty, kManifold } constraint{Constraint::kPenalty};
};

/// Schmidt 2005, eq 15, as printed: the sum over the movements of the squares of eqs 13 and 14,
/// plus lambda (q_s q_sd* + q_sd q_s*)^2, lambda = 2e6. It adds rad^2 to the square of the eye's
/// unit: give the eye in mm.
class DualQuaternionObjective {
 public:
  /// `about`: near R_X; settles the signs of the movements' quaternions near 180 degrees.
  DualQuaternionObjective(std::span<const Movement> movements, const Eigen::Quaterniond& about);

  double value(const SimilarityDualQuaternion& x) const;

  /// The minimum next to `start`; nothing when there is none.
  std::optional<SimilarityDualQuaternion> minimise(const SimilarityDualQuaternion& start,
                                                   const DualQuaternionOptions& options = {}) const;

 private:
  Eigen::Matrix<double, 12, 12>
      folded_;  ///< what similarity_rows of all movements add, as a triangle
};

}  // namespace handeye
