// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/handeye/types.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

/// Of one device, standard deviations per axis.
struct DeviceNoise {
  double rotation_deg{0};
  double translation_mm{0};
};

struct PoseSolveOptions {
  ScaleMode scale{ScaleMode::kUnknown};
  std::optional<std::string> method;  ///< only this one of the table; nothing: all of them
  /// Both given: every sigma follows from them, widened where the residuals exceed what they
  /// explain by more than chance. Else the noise is estimated from the residuals; one alone is
  /// where its estimate starts. Each number within 1e-9 and 1e6.
  std::optional<DeviceNoise> hand_noise;
  std::optional<DeviceNoise> eye_noise;
  WantedSigma wanted;
};

/// What the methods make of poses alone, without devices, images or time.
struct PoseSolution {
  /// Verdict, estimate and covariance are of maximum_likelihood whichever methods were asked for.
  /// The blocks on camera, frames, features and time offset have no meaning here.
  CalibrationResult calibration;
  ScaleMode scale{ScaleMode::kUnknown};
  std::size_t poses{0};
  /// Indices of poses that disagree with the others grossly: no method was given them, and the
  /// residuals are without them.
  std::vector<std::size_t> wrong_poses;
  /// Indices of further ones that maximum_likelihood left out in the end: beyond what the noise
  /// explains.
  std::vector<std::size_t> rejected_poses;
  std::size_t poses_used{0};   ///< by maximum_likelihood; 0: it found no answer
  PoseNoise noise;             ///< as given, or as estimated
  bool noise_estimated{true};  ///< false: given
  /// By what factor the residuals are larger than the given noise explains; 1: within chance, or
  /// the noise was estimated. The covariance and the methods' sigmas are widened by it.
  double noise_factor{1};
};

/// Solves by the methods of the table, by maximum likelihood, and judges that. The order of the
/// poses says nothing about time. Throws UsageError for a method that the table does not
/// have or noise out of its range.
PoseSolution solve_poses(std::span<const PosePair> poses, const PoseSolveOptions& options);

}  // namespace handeye
