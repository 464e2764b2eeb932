// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// Of more than `most` keyframes the one to give up: whose neighbours are nearest to each other by
/// the way the image has gone, the first and the newest `untouched` apart. Nothing where there are
/// no more than that.
std::optional<int> keyframe_to_spare(const Scene& scene, int most, int untouched);

}  // namespace handeye
