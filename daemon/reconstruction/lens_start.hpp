// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/reconstruction/reconstruction.hpp"

namespace handeye {

/// A first lens for an image of which nothing is known but its size: lenses of several fields of
/// view and distortions each reconstruct the frames and may then adjust focal length and k1; that
/// which explains most of the observations best wins. Nothing where none of them finds a start.
/// Deterministic.
std::optional<CameraModel> find_start_lens(int width, int height,
                                           std::span<const TrackedFrame> frames,
                                           const ReconstructionOptions& options);

}  // namespace handeye
