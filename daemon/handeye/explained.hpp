// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Which poses a linear solution from the `right` ones (one flag a pose) explains within
/// `tolerance` sigma, the sigma being what the right ones show: whether hand and eye put the camera
/// at the same place in the room, and turned alike. Nothing where the right poses do not determine
/// a solution. Sees what movements in pairs hide: errors along their axes' blind directions, or
/// small against the error that a long lever lends to the pitch.
std::optional<std::vector<bool>> explained_poses(std::span<const PosePair> poses,
                                                 const std::vector<bool>& right, ScaleMode scale,
                                                 double tolerance);

}  // namespace handeye
