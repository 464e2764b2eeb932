// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/lens_challenge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/lens_fit.hpp"
#include "daemon/reconstruction/lens_scene.hpp"

namespace handeye {
namespace {

constexpr std::array kFactors{0.65, 1.5};
constexpr double kChanceSigmas = 4.0;
/// Two adjustments that stop at the same minimum still stop this far apart.
constexpr double kSameFocal = 0.01;
constexpr double kClearlyWorse = 1.15;
constexpr double kAnyFocal = 10.0;  ///< standard deviation, in focal lengths, that says nothing

/// No belief about the focal length: a challenger must be driven back by the images alone.
LensPrior without_focal(const LensPrior& prior, double focal_px) {
  LensPrior free = prior;
  free.sigma[kFocal] = kAnyFocal * focal_px;
  return free;
}

}  // namespace

bool refutes_other_lenses(const CameraModel& camera, double focal_sigma_px, const LensPrior& prior,
                          const ReconstructionOptions& options, const Scene& scene) {
  const double error_px = scene_fit(camera, options.max_reprojection_px, scene).error_px;
  const double same_px = std::max(kChanceSigmas * focal_sigma_px, kSameFocal * focal_px(camera));
  return std::ranges::all_of(kFactors, [&](double factor) {
    LensVector lens = lens_vector(camera);
    lens[kFocal] *= factor;
    CameraModel other = with_lens(camera, lens);
    Scene followed = scene;
    followed.refresh_rays(other);
    adjust(other, {.robust_px = options.robust_px, .max_iterations = 15}, followed);
    fit_lens(without_focal(prior, focal_px(camera)), true, options, followed, other);
    if (std::abs(focal_px(other) - focal_px(camera)) <= same_px) return true;
    return scene_fit(other, options.max_reprojection_px, followed).error_px >
           kClearlyWorse * error_px;
  });
}

}  // namespace handeye
