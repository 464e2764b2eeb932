// SPDX-License-Identifier: BSD-3-Clause
// Of a part: which frames get which pose, while tracking, after a loss, and in the end.
#include <cmath>
#include <optional>
#include <utility>

#include "daemon/reconstruction/carrying.hpp"
#include "daemon/reconstruction/segment.hpp"

namespace handeye {
namespace {

ResectionOptions resection_options(const ReconstructionOptions& options) {
  return {options.max_reprojection_px, options.robust_px, options.min_resection_inliers,
          options.min_resection_ratio};
}

}  // namespace

bool Segment::register_frame(FrameRecord& frame, const Pose& predicted) {
  scene_.find_matches(frame, matches_);
  const auto resected = resect(camera_, matches_, predicted, resection_options(options_));
  registered_ += (resected ? 1 : 0) - (frame.eye_from_scene ? 1 : 0);
  frame.eye_from_scene.reset();
  frame.unit_covariance.setZero();
  if (!resected) return false;
  frame.eye_from_scene = resected->eye_from_scene;
  frame.inliers = resected->inliers;
  frame.reprojection_px = resected->reprojection_px;
  frame.unit_covariance = resected->unit_covariance;
  return true;
}

std::optional<Relocalisation> Segment::find(const FrameRecord& frame,
                                            const Appearances& appearances) const {
  return relocalise(camera_, frame, appearances, resection_options(options_), scene_);
}

void Segment::resume(FrameHistory::Frames frames, const Relocalisation& found,
                     const Appearances& appearances) {
  const int count = static_cast<int>(frames.size());
  for (FrameRecord& frame : frames) frames_.append(std::move(frame));
  for (const Recognition& its : found.recognised) scene_.link(its.feature_id, its.track);
  misses_ = 0;
  FrameRecord& newest = frames_.newest();
  if (!register_frame(newest, found.eye_from_scene)) return;
  insert_keyframe(newest, appearances);
  begin_adjustment();
  register_backwards(count);
}

/// Poses of all frames from the points as they are now: keyframes keep the adjusted ones, settled
/// frames go along with the frame before them, the others start from where they were.
void Segment::refresh_frames() {
  auto keyframe = scene_.keyframes.begin();
  const Pose* neighbour = nullptr;
  Pose old_from_new = Pose::Identity();
  for (FrameRecord& frame : frames_.all()) {
    const std::optional<Pose> before = frame.eye_from_scene;
    if (is_settled(frame)) {
      frame.eye_from_scene = carried(*before, old_from_new);
    } else if (frame.keyframe) {
      register_frame(frame, keyframe->eye_from_scene);
      registered_ += frame.eye_from_scene ? 0 : 1;
      frame.eye_from_scene = keyframe->eye_from_scene;
      ++keyframe;
    } else if (before || neighbour != nullptr) {
      register_frame(frame, before ? *before : *neighbour);
    }
    if (!frame.eye_from_scene) continue;
    neighbour = &*frame.eye_from_scene;
    if (before && !is_settled(frame)) old_from_new = before->inverse() * *neighbour;
  }
  register_backwards(frames_.count());
}

/// Registers those of the last frames that have no pose, each from the one after it.
void Segment::register_backwards(int count) {
  const Pose* neighbour = nullptr;
  auto& frames = frames_.all();
  for (auto frame = frames.rbegin(); frame != frames.rbegin() + count; ++frame) {
    if (!frame->eye_from_scene && neighbour != nullptr) register_frame(*frame, *neighbour);
    if (frame->eye_from_scene) neighbour = &*frame->eye_from_scene;
  }
}

/// The points, their observations counted by the frames in which the keyframes are at
/// `frame_of_keyframe`; -1: a keyframe without one.
std::vector<ScenePoint> Segment::structure(const std::vector<int>& frame_of_keyframe) const {
  std::vector<ScenePoint> structure;
  for (const Track& track : scene_.tracks) {
    if (!track.has_point) continue;
    ScenePoint point{.point_scene = track.point_scene};
    point.observations.reserve(track.observations.size());
    for (const TrackObservation& seen : track.observations) {
      const int frame = frame_of_keyframe[static_cast<std::size_t>(seen.keyframe)];
      if (seen.inlier && frame >= 0) point.observations.push_back({frame, seen.pixel});
    }
    if (!point.observations.empty()) structure.push_back(std::move(point));
  }
  return structure;
}

Reconstruction Segment::result() const {
  Reconstruction result;
  if (!started()) return result;
  result.state = ReconstructionState::kTracking;
  double sum = 0.0;
  double count = 0.0;
  std::vector<int> frame_of_keyframe(scene_.keyframes.size(), -1);
  std::size_t keyframe = 0;
  for (const FrameRecord& frame : frames_.all()) {
    while (keyframe < scene_.keyframes.size() &&
           scene_.keyframes[keyframe].frame_index < frame.index) {
      ++keyframe;
    }
    if (!frame.eye_from_scene) continue;
    if (keyframe < scene_.keyframes.size() &&
        scene_.keyframes[keyframe].frame_index == frame.index) {
      frame_of_keyframe[keyframe] = static_cast<int>(result.frames.size());
    }
    result.frames.push_back({.index = frame.index,
                             .timestamp_ns = frame.timestamp_ns,
                             .eye_from_scene = *frame.eye_from_scene,
                             .keyframe = frame.keyframe,
                             .reprojection_px = frame.reprojection_px,
                             .inliers = frame.inliers,
                             .unit_covariance = frame.unit_covariance});
    sum += frame.inliers * frame.reprojection_px * frame.reprojection_px;
    count += frame.inliers;
  }
  result.structure = structure(frame_of_keyframe);
  result.points = scene_.point_count();
  result.reprojection_px = count > 0 ? std::sqrt(sum / count) : 0.0;
  return result;
}

}  // namespace handeye
