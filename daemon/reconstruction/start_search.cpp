// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_search.hpp"

#include <algorithm>
#include <span>

namespace handeye {
namespace {

/// Movement [px at kReferenceFocalPx] after which a failed start is worth another attempt.
constexpr double kRetryMovementPx = 4.0;
/// Share of the newest frame's features wanted in the older one.
constexpr double kCommonRatio = 0.5;

}  // namespace

void StartSearch::remember_first_seen(const std::vector<FrameRecord>& frames) {
  for (const FrameObservation& seen : frames.back().observations) {
    first_seen_.try_emplace(seen.feature_id, frames.size() - 1);
  }
}

std::size_t StartSearch::oldest_with_common(const FrameRecord& newest, std::size_t common) const {
  std::vector<std::size_t> since;
  since.reserve(newest.observations.size());
  for (const FrameObservation& seen : newest.observations) {
    since.push_back(first_seen_.at(seen.feature_id));
  }
  const auto nth = since.begin() + static_cast<std::ptrdiff_t>(common - 1);
  std::nth_element(since.begin(), nth, since.end());
  return *nth;
}

bool StartSearch::moved_since_last_attempt(const std::vector<FrameRecord>& frames) const {
  const auto pairs = common_features(frames[attempted_], frames.back());
  return static_cast<int>(pairs.size()) < options_.min_common_features ||
         median_movement_px(camera_, pairs) >= kRetryMovementPx;
}

StartAttempt StartSearch::look(const std::vector<FrameRecord>& frames) {
  remember_first_seen(frames);
  StartAttempt attempt;
  const FrameRecord& newest = frames.back();
  const auto fewest = static_cast<std::size_t>(options_.min_common_features);
  if (frames.size() < 2 || newest.observations.size() < fewest) return attempt;
  if (attempted_ > 0 && !moved_since_last_attempt(frames)) {
    attempt.state = last_state_;
    return attempt;
  }
  const auto wanted = std::max(
      fewest,
      static_cast<std::size_t>(kCommonRatio * static_cast<double>(newest.observations.size())));
  // First the older frame that shares plenty; if that gives no baseline, the oldest possible.
  std::size_t tried = frames.size() - 1;
  for (const std::size_t common : {wanted, fewest}) {
    const std::size_t oldest = oldest_with_common(newest, common);
    if (oldest >= tried) continue;
    tried = oldest;
    attempt = start_scene(camera_, options_, std::span(frames).subspan(oldest));
    if (attempt.scene) return attempt;
  }
  if (attempt.costly) attempted_ = frames.size() - 1;
  last_state_ = attempt.state;
  return attempt;
}

}  // namespace handeye
