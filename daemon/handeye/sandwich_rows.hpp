// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/types.hpp"

namespace handeye::sandwich {

/// The equations whose squares the methods add up.
enum class Rows {
  kTranslation,             ///< eq 5
  kQuaternions,             ///< q_E q - q q_H
  kLogarithms,              ///< log R_E - R_X log R_H
  kAxes,                    ///< of the same length
  kGibbsVector,             ///< Tsai, Lenz
  kAxisFrames,              ///< Shiu, Ahmad, on nine entries
  kScrewMoments,            ///< Chen: of the screws' lines
  kQuaternionsTranslation,  ///< eq 7; mm
  kDualQuaternionVectors,   ///< Daniilidis: vector parts; normalised unit
  kSimilarityQuaternions,   ///< eqs 13 and 14; mm
  kEntriesTranslation,      ///< Andreff, on nine entries; normalised unit
};

/// Rows of one movement to first order: rows = of_error * (delta, epsilon) + of_shape * shape.
struct LinearRows {
  static constexpr int kMost = 12;
  /// delta: R_X R_H R_X^T R_E^T = Exp(delta). epsilon: (I - R_E) t_X - t_E + R_X t_H.
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMost, 6> of_error;
  /// Of the symmetric S in (1 + S) R_X, where the nine entries are free: the diagonal as
  /// (a, b, -a-b), the entries (1,2), (0,2), (0,1), and what all of the diagonal share.
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMost, 6> of_shape;
};

/// Linearised where X explains the hand's movement exactly; eye_from_hand in mm. `unit_mm`: of the
/// translations in the rows.
LinearRows linear_rows(Rows rows, const Pose& hand_j_from_hand_i, const Pose& eye_from_hand,
                       double unit_mm);

}  // namespace handeye::sandwich
