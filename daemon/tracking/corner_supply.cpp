// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/corner_supply.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace handeye {
namespace {

/// Of all cells, so many are searched in a frame, and more of them while features are few. Cells
/// without texture stay empty and would otherwise cost a full detection in every frame.
constexpr int kCellsFraction = 6;
constexpr int kStarvingFraction = 3;
/// While few have been found, so many frames from the start or a loss are searched as a whole: a
/// reconstruction starts with what it gets then.
constexpr int kSettlingFrames = 25;
/// More cells than features wanted: in an endoscopy many are empty of texture or under a highlight.
constexpr double kCellsPerFeature = 1.8;
/// Usable areas that differ by less share a grid.
constexpr double kSameShare = 0.2;
constexpr double kLeastShare = 0.02;
constexpr float kWeakestCorner = 0.2F;  ///< (grey levels / px)^2

}  // namespace

const std::vector<Corner>& CornerSupply::find(const ImagePyramid& pyramid, int halvings,
                                              const TrackTable& tracks) {
  fit_grid(pyramid, halvings);
  corners_.clear();
  if (tracks.room() > 0) {
    grid_->detect(pyramid, tracks.pixel, cells_to_search(tracks.size()), corners_);
    keep_the_best(tracks);
  }
  features_before_ = tracks.size() + corners_.size();
  return corners_;
}

void CornerSupply::fit_grid(const ImagePyramid& pyramid, int halvings) {
  const double share = std::max(pyramid.usable_share(), kLeastShare);
  if (grid_ && std::abs(share - grid_share_) <= kSameShare * grid_share_) return;
  const double cells = kCellsPerFeature * options_.max_features;
  if (!grid_) {
    grid_.emplace(pyramid.grey(0).size(), static_cast<int>(cells),
                  options_.min_distance_px / (1 << halvings));
    corners_.reserve(static_cast<std::size_t>(grid_->most_cells()));
  }
  grid_share_ = share;
  grid_->cut(static_cast<int>(cells / share));
}

int CornerSupply::cells_to_search(std::size_t features) {
  const int all = grid_->cell_count();
  // With nothing to follow there is time to search everywhere.
  if (features == 0 || 2 * features < features_before_) frames_since_loss_ = 0;
  if (2 * features >= static_cast<std::size_t>(options_.max_features)) return all / kCellsFraction;
  if (frames_since_loss_ >= kSettlingFrames) return all / kStarvingFraction;
  ++frames_since_loss_;
  return all;
}

void CornerSupply::keep_the_best(const TrackTable& tracks) {
  float strongest = 0;
  for (const float strength : tracks.strength) strongest = std::max(strongest, strength);
  for (const Corner& corner : corners_) strongest = std::max(strongest, corner.strength);
  const float weakest = std::max(kWeakestCorner, static_cast<float>(options_.quality) * strongest);
  std::erase_if(corners_, [&](const Corner& corner) { return corner.strength < weakest; });
  if (corners_.size() <= tracks.room()) return;
  std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) {
    return std::tuple(-a.strength, a.y, a.x) < std::tuple(-b.strength, b.y, b.x);
  });
  corners_.resize(tracks.room());
}

}  // namespace handeye
