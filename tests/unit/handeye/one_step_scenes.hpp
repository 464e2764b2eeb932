// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/handeye/one_step/one_step.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "tests/unit/handeye/one_step_tracks.hpp"

/// The problem of docs/math.md section 8 on synthetic tracks with known truth.
namespace handeye::synthetic {

struct OneStepSceneOptions {
  TrackOptions tracks;
  int keyframe_interval{4};            ///< every so many frames one
  std::optional<IntrinsicsMode> lens;  ///< adjusted, with such a prior; nothing: the true one given
  double tracker_hz{60};
  bool smooth_hands{false};  ///< over the samples around a frame; else the line between two
  double hand_rotation_sigma_rad{rad_from_deg(0.1)};  ///< of a sample, per axis
  double hand_translation_sigma_mm{0.2};              ///< likewise
  /// The noise changes over time and is larger along one axis, as the samples' covariance says; the
  /// figures above are about its mean.
  bool hand_noise_varies{false};
  double outlier_samples{0};           ///< share of the tracker's samples that are grossly wrong
  double time_offset_error_s{0.0015};  ///< of the look-up: what is to be found
};

struct OneStepScene {
  OneStepSceneOptions options;           ///< as asked, but from when the motion was taken
  Tracks tracks;                         ///< with the true poses, points and lens
  Pose hand_from_eye{Pose::Identity()};  ///< the truth
  double time_offset_error_s{0};
  std::optional<LensPrior> lens_prior;      ///< its mean is off by what it says
  std::vector<Matrix6d> sample_covariance;  ///< the truth, of each sample of the tracker
  OneStepProblem problem;
};

/// One seed: another stretch of the motion, other points, other noise.
OneStepScene one_step_scene(const OneStepSceneOptions& options, std::uint32_t seed);

/// The frames with a hand, as the likelihood takes them.
std::vector<HandEyeObservation> observations_of(const OneStepProblem& problem);

/// As the daemon starts: by likelihood, the offset free, all noise estimated.
std::optional<MaximumLikelihoodResult> start_of(const OneStepScene& scene);

/// Options that know what a user would: the tracker's noise in `given`, the image's from the
/// residuals.
OneStepOptions one_step_options(const OneStepScene& scene, HandNoiseSource source);

}  // namespace handeye::synthetic
