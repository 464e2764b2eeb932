// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_window.hpp"

#include <algorithm>

namespace handeye {
namespace {

/// Frames looked at for the spread, however long the stretch is.
constexpr std::size_t kLookedAt = 33;
/// Share of the common features that a frame between must show.
constexpr double kMinShown = 0.9;

std::vector<std::int64_t> common_ids(const std::vector<std::int64_t>& features,
                                     const FrameRecord& frame) {
  std::vector<std::int64_t> common;
  common.reserve(features.size());
  auto seen = frame.observations.begin();
  for (const std::int64_t id : features) {
    while (seen != frame.observations.end() && seen->feature_id < id) ++seen;
    if (seen != frame.observations.end() && seen->feature_id == id) common.push_back(id);
  }
  return common;
}

std::vector<std::int64_t> feature_ids(const FrameRecord& frame) {
  std::vector<std::int64_t> ids;
  ids.reserve(frame.observations.size());
  for (const FrameObservation& seen : frame.observations) ids.push_back(seen.feature_id);
  return ids;
}

/// Evenly many frames between the ends that show nearly all of the features.
std::vector<const FrameRecord*> candidate_frames(std::span<const FrameRecord> frames,
                                                 const std::vector<std::int64_t>& features) {
  std::vector<const FrameRecord*> candidates;
  const std::size_t steps = std::min(kLookedAt, frames.size()) - 1;
  const double enough = kMinShown * static_cast<double>(features.size());
  for (std::size_t step = 0; step <= steps; ++step) {
    const FrameRecord& frame = frames[step * (frames.size() - 1) / std::max<std::size_t>(1, steps)];
    if (static_cast<double>(common_ids(features, frame).size()) >= enough) {
      candidates.push_back(&frame);
    }
  }
  return candidates;
}

/// Of the candidates those nearest to even steps of the movement summed up.
std::vector<const FrameRecord*> spread(const CameraModel& camera,
                                       const std::vector<const FrameRecord*>& candidates,
                                       int count) {
  if (static_cast<int>(candidates.size()) <= count) return candidates;
  std::vector<double> travel(candidates.size(), 0.0);
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    travel[i] = travel[i - 1] +
                median_movement_px(camera, common_features(*candidates[i - 1], *candidates[i]));
  }
  std::vector<const FrameRecord*> chosen{candidates.front()};
  std::size_t position = 0;
  for (int step = 1; step + 1 < count; ++step) {
    const double wanted = travel.back() * step / (count - 1);
    while (position + 2 < candidates.size() && travel[position] < wanted) ++position;
    if (candidates[position] != chosen.back()) chosen.push_back(candidates[position]);
  }
  chosen.push_back(candidates.back());
  return chosen;
}

void keep_columns(const std::vector<bool>& usable, StartWindow& window) {
  Eigen::Index kept = 0;
  for (std::size_t p = 0; p < usable.size(); ++p) {
    if (!usable[p]) continue;
    const auto column = static_cast<Eigen::Index>(p);
    window.pixels.col(kept) = window.pixels.col(column).eval();
    window.rays.col(kept) = window.rays.col(column).eval();
    window.features[static_cast<std::size_t>(kept)] = window.features[p];
    ++kept;
  }
  window.features.resize(static_cast<std::size_t>(kept));
  window.pixels.conservativeResize(Eigen::NoChange, kept);
  window.rays.conservativeResize(Eigen::NoChange, kept);
}

/// Pixels and rays of all features in all frames; features that have no ray somewhere are dropped.
void fill_columns(const CameraModel& camera, StartWindow& window) {
  const auto rows = static_cast<Eigen::Index>(2 * window.frames.size());
  window.pixels.resize(rows, static_cast<Eigen::Index>(window.features.size()));
  window.rays.resizeLike(window.pixels);
  std::vector<bool> usable(window.features.size(), true);
  for (std::size_t f = 0; f < window.frames.size(); ++f) {
    auto seen = window.frames[f]->observations.begin();
    const auto row = static_cast<Eigen::Index>(2 * f);
    for (std::size_t p = 0; p < window.features.size(); ++p) {
      while (seen->feature_id < window.features[p]) ++seen;
      const Eigen::Vector2d pixel(seen->x, seen->y);
      const auto ray = unproject(camera, pixel);
      if (!ray) usable[p] = false;
      const auto column = static_cast<Eigen::Index>(p);
      window.pixels.col(column).segment<2>(row) = pixel;
      window.rays.col(column).segment<2>(row) = ray.value_or(Eigen::Vector2d::Zero());
    }
  }
  keep_columns(usable, window);
}

}  // namespace

std::vector<RayPair> StartWindow::pairs_with_first(Eigen::Index frame) const {
  std::vector<RayPair> pairs;
  pairs.reserve(features.size());
  for (Eigen::Index p = 0; p < feature_count(); ++p) {
    pairs.push_back({rays.col(p).head<2>(), rays.col(p).segment<2>(2 * frame)});
  }
  return pairs;
}

void StartWindow::find_matches(Eigen::Index frame,
                               const std::vector<std::optional<Eigen::Vector3d>>& points,
                               std::vector<PointMatch>& matches) const {
  matches.clear();
  for (Eigen::Index p = 0; p < feature_count(); ++p) {
    const auto& point = points[static_cast<std::size_t>(p)];
    if (point) matches.push_back({*point, pixels.col(p).segment<2>(2 * frame)});
  }
}

FrameRecord StartWindow::thinned(Eigen::Index frame, Eigen::Index most) const {
  const FrameRecord& whole = *frames[static_cast<std::size_t>(frame)];
  FrameRecord record;
  record.index = whole.index;
  record.timestamp_ns = whole.timestamp_ns;
  const Eigen::Index count = std::min(most, feature_count());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index p = i * feature_count() / count;
    record.observations.push_back({features[static_cast<std::size_t>(p)],
                                   static_cast<float>(pixels(2 * frame, p)),
                                   static_cast<float>(pixels(2 * frame + 1, p))});
  }
  return record;
}

StartWindow make_start_window(const CameraModel& camera, std::span<const FrameRecord> frames,
                              int frame_count) {
  StartWindow window;
  window.features = common_ids(feature_ids(frames.front()), frames.back());
  window.frames = spread(camera, candidate_frames(frames, window.features), frame_count);
  for (const FrameRecord* frame : window.frames) {
    window.features = common_ids(window.features, *frame);
  }
  fill_columns(camera, window);
  return window;
}

}  // namespace handeye
