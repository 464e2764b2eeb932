// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/keyframe_thinning.hpp"

namespace handeye {

std::optional<int> keyframe_to_spare(const Scene& scene, int most, int untouched) {
  const int count = static_cast<int>(scene.keyframes.size());
  if (count <= most) return std::nullopt;
  std::optional<int> weakest;
  double smallest_px = 0.0;
  for (int k = 1; k < count - untouched; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double gap_px = scene.keyframes[i + 1].travel_px - scene.keyframes[i - 1].travel_px;
    if (weakest && gap_px >= smallest_px) continue;
    weakest = k;
    smallest_px = gap_px;
  }
  return weakest;
}

}  // namespace handeye
