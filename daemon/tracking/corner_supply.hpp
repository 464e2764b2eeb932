// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/tracking/corner_grid.hpp"
#include "daemon/tracking/feature_tracker.hpp"
#include "daemon/tracking/track_table.hpp"

namespace handeye {

/// Where new features come from: the best corners of what is empty of features. Each image is
/// searched a part at a time; as a whole only in some frames at the start and after most were lost.
class CornerSupply {
 public:
  explicit CornerSupply(const TrackerOptions& options) : options_(options) {}

  /// Corners to be added to the features in an image, no more than there is room for. `halvings`:
  /// of the image's size to the pyramid's level 0.
  const std::vector<Corner>& find(const ImagePyramid& pyramid, int halvings,
                                  const TrackTable& tracks);

 private:
  void fit_grid(const ImagePyramid& pyramid, int halvings);
  int cells_to_search(std::size_t features);
  void keep_the_best(const TrackTable& tracks);

  TrackerOptions options_;
  std::optional<CornerGrid> grid_;
  double grid_share_{0};  ///< of the image that could be used when the grid was cut
  std::size_t features_before_{0};
  int frames_since_loss_{0};  ///< that were searched as a whole
  std::vector<Corner> corners_;
};

}  // namespace handeye
