// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include "daemon/geometry/camera_model.hpp"

namespace handeye {

/// What a calibration does about the lens.
enum class IntrinsicsMode {
  kFixed,     ///< taken as given
  kRefine,    ///< starts as given; f, c, k1, k2 are free in the final adjustment
  kEstimate,  ///< nothing is known but the size of the image
};

/// The lens as far as it is known before the first image; nothing where it is to be estimated.
std::optional<CameraModel> known_lens(const CameraModel& camera, IntrinsicsMode mode);

/// "fixed", "refine", "estimate".
std::string_view intrinsics_word(IntrinsicsMode mode);
std::optional<IntrinsicsMode> intrinsics_from_word(std::string_view word);

}  // namespace handeye
