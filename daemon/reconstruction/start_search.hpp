// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/scene_start.hpp"

namespace handeye {

/// Finds, while frames arrive, the two between which a reconstruction can start: against the newest
/// the oldest that still shares enough features with it, for the widest baseline.
class StartSearch {
 public:
  StartSearch(const CameraModel& camera, const ReconstructionOptions& options)
      : camera_(camera), options_(options) {}

  /// Looks at the newest (last) of the frames; to be called once for each.
  StartAttempt look(const std::vector<FrameRecord>& frames);

 private:
  void remember_first_seen(const std::vector<FrameRecord>& frames);
  std::size_t oldest_with_common(const FrameRecord& newest, std::size_t common) const;
  bool moved_since_last_attempt(const std::vector<FrameRecord>& frames) const;

  const CameraModel& camera_;
  const ReconstructionOptions& options_;
  std::unordered_map<std::int64_t, std::size_t> first_seen_;  ///< feature to position of the frame
  std::size_t attempted_{0};                                  ///< frame of the last attempt
  ReconstructionState last_state_{ReconstructionState::kTooFewFeatures};
};

}  // namespace handeye
