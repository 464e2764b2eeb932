// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Hand and eye at one instant, and how the hand was moving.
struct HandEyeObservation {
  PosePair poses;
  Eigen::Vector3d hand_angular_velocity{Eigen::Vector3d::Zero()};  ///< in the hand frame [rad/s]
  Eigen::Vector3d hand_velocity{Eigen::Vector3d::Zero()};  ///< of its origin, in the room [mm/s]
  int part{0};  ///< poses of one part share room_from_scene and scale; hand_from_eye all share
};

struct MaximumLikelihoodOptions {
  PoseNoise noise;            ///< assumed; the start where it is estimated
  bool estimate_noise{true};  ///< from the residuals (variance components)
  /// The observations are in order of time: what the residuals show to be correlated counts as
  /// fewer poses. False: their order means nothing.
  bool account_for_correlation{true};
  bool estimate_scale{true};         ///< false: the start's scale is exact; without a start it is 1
  double log_scale_prior{0.5};       ///< standard deviation about the start: keeps a scale finite
  bool estimate_time_offset{false};  ///< needs velocities
  double time_offset_prior_s{0.05};  ///< standard deviation of the correction before the data
  double huber{4.0};   ///< of a whitened residual's norm (6 dof): touches 1.4 % of inliers
  double reject{6.0};  ///< poses beyond this norm are left out in the end; 0: none
  int rounds{8};       ///< at most, of solving and estimating the noise
};

/// Square roots of the traces of the rotation's and the translation's block of a covariance of
/// (w [rad], dt [mm]): the figures that are wanted, reported and judged.
double sigma_rotation_deg(const Matrix6d& covariance);
double sigma_translation_mm(const Matrix6d& covariance);

/// What became of one part.
struct PartResult {
  int number{0};              ///< HandEyeObservation::part
  std::size_t poses{0};       ///< that were given
  std::size_t poses_used{0};  ///< without the outliers; 0: left out altogether
  double scale_units_per_mm{1};
  double log_scale_sigma{0};
  Pose room_from_scene{Pose::Identity()};  ///< scene in mm
  PoseNoise noise;                         ///< as estimated, or as assumed
  double chi2_per_dof{0};                  ///< against the assumed noise
  /// By how much what all parts agree on fits it worse than an answer of its own does: by chance a
  /// chi2 of as many degrees of freedom as there are common unknowns (6, 7 with the time offset).
  double disagreement_chi2{0};
};

struct MaximumLikelihoodResult {
  HandEyeSolution solution;                ///< its scale is that of `part`
  int part{0};                             ///< the largest that was used
  Pose room_from_scene{Pose::Identity()};  ///< scene of `part`, in mm
  /// To be added to the time offset that the hand poses were looked up with (first order: look up
  /// again after more than some milliseconds).
  double time_offset_correction_s{0};
  double time_offset_sigma_s{0};
  /// Of (w [rad], dt [mm]) in R = Exp(w) R_estimate, t = t_estimate + dt of hand_from_eye. Finite
  /// and huge where the data do not determine the answer.
  Matrix6d covariance{Matrix6d::Zero()};
  double log_scale_sigma{0};
  double sigma_translation_known_scale_mm{0};  ///< as sigma_translation_mm, were the scale known
  std::size_t poses_used{0};                   ///< without the outliers
  std::vector<std::size_t> rejected;           ///< the outliers: indices of observations, ascending
  double chi2_per_dof{0};                      ///< against the assumed noise
  PoseNoise noise;                             ///< of `part`; as estimated, or as assumed
  double correlation_inflation{1};             ///< of the covariance, for errors correlated in time
  /// Likewise, for parts that agree less than chance allows.
  double disagreement_inflation{1};
  std::vector<PartResult> parts;  ///< the largest first

  double sigma_rotation_deg() const;    ///< square root of the trace of w's block
  double sigma_translation_mm() const;  ///< square root of the trace of dt's block
};

/// Hand-eye over poses, not pairs (docs/math.md section 4): for every pose k
///   room_from_hand_k * hand_from_eye = room_from_scene * scene_from_eye_k (scaled by 1/s),
/// weighted by hand and eye noise, Huber's loss; unknown are hand_from_eye, for each part a
/// room_from_scene of its own and, if wanted, s, and a correction of the time offset.
/// `observations` in order of time, unless their correlation is not accounted for. A part that
/// contradicts those that together have more poses is left out (part_agreement.hpp). The start's
/// scale is the largest part's. One thread: the same answer every time. Nothing for fewer than
/// three poses in every part, numbers that are not finite, matrices that are not rotations or noise
/// that is not positive.
std::optional<MaximumLikelihoodResult> maximum_likelihood(
    std::span<const HandEyeObservation> observations, const HandEyeSolution& start,
    const MaximumLikelihoodOptions& options = {});

/// The same from every start that linear methods offer; the likeliest. Nothing, too, where they
/// find that not even the rotation is determined.
std::optional<MaximumLikelihoodResult> maximum_likelihood(
    std::span<const HandEyeObservation> observations, const MaximumLikelihoodOptions& options = {});

}  // namespace handeye
