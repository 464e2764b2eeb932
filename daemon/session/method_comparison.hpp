// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

struct ComparisonOptions {
  ScaleMode scale{ScaleMode::kUnknown};
  PoseNoise noise;
  bool estimate_noise{true};
  bool sigma{false};  ///< carry the noise through each method's equations to its own sigma
  std::optional<PoseNoise> sigma_noise;  ///< of the poses, for that; nothing: the one above
  double sigma_factor{1};  ///< every sigma times this: by what the residuals exceed the noise
};

/// Each method's answer to the same selection of movements, with its residuals over all poses and
/// its time, which is that of the method alone.
std::vector<MethodResult> compare_methods(std::span<const Method> methods,
                                          std::span<const PosePair> poses,
                                          const ComparisonOptions& options);

/// The same without sigmas, which cost time.
inline std::vector<MethodResult> compare_methods(std::span<const Method> methods,
                                                 std::span<const PosePair> poses,
                                                 const PoseNoise& noise,
                                                 ScaleMode scale = ScaleMode::kUnknown) {
  return compare_methods(methods, poses, ComparisonOptions{.scale = scale, .noise = noise});
}

/// Of the covariance of a hand_from_eye.
MethodSigma sigma_of(const Matrix6d& covariance);

}  // namespace handeye
