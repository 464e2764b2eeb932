// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/scene_start.hpp"

namespace handeye {

/// Finds, while frames arrive, the two between which a reconstruction can start: against the newest
/// the oldest that still shares enough features with it, for the widest baseline. What was refused
/// is tried again after some movement, twice as much each time up to a bound, as long as the same
/// scene is in view: attempts are costly, and where several failed the next few pixels hardly help.
class StartSearch {
 public:
  StartSearch(const CameraModel& camera, const ReconstructionOptions& options)
      : camera_(camera), options_(options) {}

  /// Looks at the newest (last) of the frames; to be called once for each.
  StartAttempt look(const std::vector<FrameRecord>& frames);

 private:
  void remember_first_seen(const std::vector<FrameRecord>& frames);
  std::size_t oldest_with_common(const FrameRecord& newest, std::size_t common) const;
  /// At kReferenceFocalPx; nothing where the scene is another or there was no attempt.
  std::optional<double> moved_since_last_attempt_px(const std::vector<FrameRecord>& frames) const;
  StartAttempt attempt_with(const std::vector<FrameRecord>& frames) const;

  const CameraModel& camera_;
  const ReconstructionOptions& options_;
  std::unordered_map<std::int64_t, std::size_t> first_seen_;  ///< feature to position of the frame
  std::optional<std::size_t> attempted_;                      ///< frame of the last costly attempt
  double retry_px_{0};  ///< movement since, from which on another follows
  ReconstructionState last_state_{ReconstructionState::kTooFewFeatures};
};

}  // namespace handeye
