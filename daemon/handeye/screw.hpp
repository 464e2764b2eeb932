// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <span>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// What hand and eye see alike of one movement whatever X is (Chen 1991, screw congruence): the
/// angle, and the pitch, that is the advance along the axis, up to the scale.
struct ScrewPair {
  double hand_angle_rad{0};
  double eye_angle_rad{0};
  double hand_pitch_mm{0};
  double eye_pitch{0};       ///< scene units
  double hand_radius_mm{0};  ///< from the origin to the screw axis: the lever of the axis' error
  double eye_radius{0};      ///< scene units
};

ScrewPair screw_pair(const Movement& movement);

/// How well hand and eye agree in a set of movements, most of which are right.
struct ScrewAgreement {
  double mm_per_unit{1};
  double reference_mm_per_unit{1};  ///< ratio of the path lengths; shares out the eye's noise
  /// Hand's and eye's distances from the axis differ by no more: by a lever arm at most.
  double radius_difference_mm{std::numeric_limits<double>::infinity()};
  double angle_sigma_rad{0};  ///< of hand's against eye's angle
  double pitch_sigma{0};      ///< of the pitches' difference, in units of its lever: about rad

  /// Difference of the pitches by the lever through which noise acts on them; a lever that the
  /// other side does not know is an error itself, and does not excuse any. Near half a turn the
  /// sign of the axis, and with it of the pitch, is arbitrary.
  double pitch_difference(const ScrewPair& pair) const;

  /// Whether the movement turns far enough for its axis to mean something.
  bool can_judge(const ScrewPair& pair, double min_angle_rad) const;

  /// Whether both differences are within so many sigma.
  bool agrees(const ScrewPair& pair, double tolerance) const;
};

/// The scale from the pitches (least quantile of squares over hypotheses from single movements,
/// deterministic) and both sigmas from the same quantile. `quantile`: the share of the movements
/// that is certainly right. Nothing where there are no movements.
std::optional<ScrewAgreement> screw_agreement(std::span<const ScrewPair> pairs, ScaleMode scale,
                                              double quantile);

}  // namespace handeye
