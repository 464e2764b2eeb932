// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/reconstruction/bundle_adjustment.hpp"
#include "daemon/reconstruction/reconstruction.hpp"

namespace handeye {

/// Which parameters of the lens are free.
std::array<bool, kLensParameters> free_lens(std::span<const LensParameter> parameters);

/// Every parameter there is.
std::array<bool, kLensParameters> whole_lens();

/// Adjusts poses, points and the lens, which is freed step by step: the focal length, then k1, then
/// the centre, the aspect and k2 - what is freed first is what the images determine best, and what
/// comes later must not make up for it. Between the steps points are won anew and observations
/// judged. `last_stage` false: stops before the last step.
void fit_lens(const LensPrior& prior, bool last_stage, const ReconstructionOptions& options,
              Scene& scene, CameraModel& camera);

/// The same for a lens that is nearly right: everything is free at once.
void polish_lens(const LensPrior& prior, const ReconstructionOptions& options, Scene& scene,
                 CameraModel& camera);

}  // namespace handeye
