// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_search.hpp"

#include <algorithm>
#include <span>

namespace handeye {
namespace {

/// Movement [px at kReferenceFocalPx] after which a failed start is worth another attempt: the
/// first, by what factor more each next, and at most.
constexpr double kFirstRetryPx = 4.0;
constexpr double kRetryGrowth = 2.0;
constexpr double kMostRetryPx = 32.0;
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

std::optional<double> StartSearch::moved_since_last_attempt_px(
    const std::vector<FrameRecord>& frames) const {
  if (!attempted_) return std::nullopt;
  const auto pairs = common_features(frames[*attempted_], frames.back());
  if (static_cast<int>(pairs.size()) < options_.min_common_features) return std::nullopt;
  return median_movement_px(camera_, pairs);
}

/// First with the older frame that shares plenty; if that gives no baseline, the oldest possible.
StartAttempt StartSearch::attempt_with(const std::vector<FrameRecord>& frames) const {
  const FrameRecord& newest = frames.back();
  const auto fewest = static_cast<std::size_t>(options_.min_common_features);
  const auto wanted = std::max(
      fewest,
      static_cast<std::size_t>(kCommonRatio * static_cast<double>(newest.observations.size())));
  StartAttempt attempt;
  std::size_t tried = frames.size() - 1;
  for (const std::size_t common : {wanted, fewest}) {
    const std::size_t oldest = oldest_with_common(newest, common);
    if (oldest >= tried) continue;
    tried = oldest;
    const bool costly_before = attempt.costly;
    attempt = start_scene(camera_, options_, std::span(frames).subspan(oldest));
    attempt.costly = attempt.costly || costly_before;
    if (attempt.scene) break;
  }
  return attempt;
}

StartAttempt StartSearch::look(const std::vector<FrameRecord>& frames) {
  remember_first_seen(frames);
  StartAttempt attempt;
  const auto seen = static_cast<int>(frames.back().observations.size());
  if (frames.size() < 2 || seen < options_.min_common_features) return attempt;
  const auto moved_px = moved_since_last_attempt_px(frames);
  if (moved_px && *moved_px < retry_px_) {
    attempt.state = last_state_;
    return attempt;
  }
  attempt = attempt_with(frames);
  if (attempt.costly) {
    attempted_ = frames.size() - 1;
    retry_px_ = moved_px ? std::min(kRetryGrowth * retry_px_, kMostRetryPx) : kFirstRetryPx;
  }
  last_state_ = attempt.state;
  return attempt;
}

}  // namespace handeye
