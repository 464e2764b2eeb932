// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

namespace handeye::simulator {

/// What the endoscope looks at where it is no calibration board.
enum class SceneKind {
  kTissue,  ///< hills with vessels, glands and grain on them
  kPlane,   ///< the same texture on a flat surface: two views of it allow two motions
  kBare,    ///< the hills alone, evenly coloured: nothing but shading, which moves with the light
};

/// The name on the command line: tissue, plane, bare.
std::string_view scene_name(SceneKind kind);
std::optional<SceneKind> scene_from_name(std::string_view name);

}  // namespace handeye::simulator
