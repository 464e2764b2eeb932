// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/reconstruction/scene.hpp"
#include "daemon/tracking/feature_tracker.hpp"

namespace handeye {

/// What the features look like that are being tracked, as far as it has been told.
class Appearances {
 public:
  /// Takes a frame's descriptions in and forgets features that it no longer shows.
  void update(const TrackedFrame& frame);

  /// Nothing yet: nullptr.
  const AppearanceBits* find(std::int64_t feature_id) const;

  /// Features told of since the start.
  std::int64_t told() const { return told_; }

 private:
  std::vector<FeatureDescription> living_;  ///< ordered by feature_id
  std::int64_t told_{0};
};

}  // namespace handeye
