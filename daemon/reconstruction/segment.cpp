// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/segment.hpp"

#include <algorithm>
#include <utility>

#include "daemon/reconstruction/carrying.hpp"
#include "daemon/reconstruction/final_adjustment.hpp"
#include "daemon/reconstruction/keyframe_thinning.hpp"
#include "daemon/reconstruction/point_trust.hpp"
#include "daemon/reconstruction/scene_points.hpp"

namespace handeye {
namespace {

/// Frames in a row without a pose after which the part is given up for the time being: occlusions
/// this short are bridged as long as the features survive them.
constexpr int kMaxMisses = 5;
/// A frame that sees less than this share of the last keyframe's points becomes a keyframe itself.
constexpr double kKeyframeInlierRatio = 0.7;
/// Where frames are few every one counts: after so long a smaller movement makes a keyframe.
constexpr std::int64_t kLongAgo_ns = 300'000'000;
constexpr double kMovedPx = 1.0;
constexpr int kWindowIterations = 6;
/// Trust of the points that a part starts with: several views have agreed on them.
constexpr int kStartTrust = 4;
/// Frames kept while looking for a start; older ones no longer share features with the newest.
constexpr int kMostFramesBeforeStart = 1000;

PointOptions point_options(const ReconstructionOptions& options) {
  return {options.max_reprojection_px, options.min_triangulation_deg};
}

}  // namespace

Segment::Segment(const CameraModel& camera, const ReconstructionOptions& options,
                 AdjustmentThread& thread)
    : camera_(camera), options_(options), adjuster_(thread, options.background) {
  search_.emplace(camera, options);
}

ReconstructionState Segment::add(FrameRecord frame, const Appearances& appearances) {
  FrameRecord& newest = frames_.append(std::move(frame));
  if (adjuster_.count_frame()) take_over_adjustment();
  if (!started()) return search_start(appearances);
  if (!register_frame(newest, frames_.predict_newest())) {
    ++misses_;
    return ReconstructionState::kTracking;
  }
  misses_ = 0;
  update_trust(camera_, *newest.eye_from_scene, matches_, options_.max_reprojection_px, scene_);
  if (wants_keyframe(newest)) {
    insert_keyframe(newest, appearances);
    begin_adjustment();
  }
  frames_.bound_memory(options_.max_observed_frames);
  return ReconstructionState::kTracking;
}

bool Segment::lost() const {
  if (started()) return misses_ >= kMaxMisses;
  if (frames_.count() < 2) return false;
  const auto& frames = frames_.all();
  const auto common = common_features(frames[frames.size() - 2], frames.back());
  return static_cast<int>(common.size()) < options_.min_common_features;
}

FrameHistory::Frames Segment::take_lost_frames() {
  FrameHistory::Frames lost = frames_.take_last(started() ? std::exchange(misses_, 0) : 1);
  // A finish() in between may have found one a pose after all: it is of this scene, not the next.
  for (FrameRecord& frame : lost) {
    registered_ -= frame.eye_from_scene ? 1 : 0;
    frame.eye_from_scene.reset();
    frame.inliers = 0;
  }
  return lost;
}

FrameHistory::Frames Segment::take_all_frames() {
  return frames_.take_last(frames_.count());
}

ReconstructionState Segment::search_start(const Appearances& appearances) {
  if (frames_.count() > kMostFramesBeforeStart) {
    frames_.drop_first(kMostFramesBeforeStart / 2);
    search_.emplace(camera_, options_);
  }
  StartAttempt attempt = search_->look(frames_.all());
  if (attempt.scene) adopt(std::move(*attempt.scene), appearances);
  return attempt.state;
}

/// Takes the started scene over and registers all frames so far, outwards from those it has.
void Segment::adopt(Scene scene, const Appearances& appearances) {
  scene_ = std::move(scene);
  search_.reset();
  for (Track& track : scene_.tracks) {
    if (track.has_point) track.trust = kStartTrust;
  }
  for (std::size_t k = 0; k < scene_.keyframes.size(); ++k) {
    Keyframe& keyframe = scene_.keyframes[k];
    FrameRecord& frame = *frames_.find(keyframe.frame_index);
    register_frame(frame, keyframe.eye_from_scene);
    frame.eye_from_scene = keyframe.eye_from_scene;
    frame.keyframe = true;
    keyframe_inliers_ = frame.inliers;
    scene_.note_appearances(static_cast<int>(k), appearances);
    if (k == 0) continue;
    const Keyframe& before = scene_.keyframes[k - 1];
    keyframe.travel_px =
        before.travel_px +
        median_movement_px(camera_, common_features(*frames_.find(before.frame_index), frame));
  }
  refresh_frames();
}

bool Segment::wants_keyframe(const FrameRecord& frame) const {
  if (frame.inliers < kKeyframeInlierRatio * keyframe_inliers_) return true;
  const FrameRecord* before = frames_.find(scene_.keyframes.back().frame_index);
  const double moved_px = median_movement_px(camera_, common_features(*before, frame));
  const bool long_ago = frame.timestamp_ns - before->timestamp_ns >= kLongAgo_ns;
  return moved_px >= (long_ago ? kMovedPx : options_.keyframe_parallax_px);
}

void Segment::insert_keyframe(FrameRecord& frame, const Appearances& appearances) {
  const Keyframe& last = scene_.keyframes.back();
  const double moved_px =
      median_movement_px(camera_, common_features(*frames_.find(last.frame_index), frame));
  frame.keyframe = true;
  keyframe_inliers_ = frame.inliers;
  scene_.add_keyframe(camera_, frame, *frame.eye_from_scene, last.travel_px + moved_px);
  const int newest = keyframe_count() - 1;
  scene_.note_appearances(newest, appearances);
  triangulate_tracks(camera_, point_options(options_), newest, scene_);
  judge_observations(camera_, point_options(options_), newest, scene_);
}

void Segment::begin_adjustment() {
  AdjustmentOptions adjustment;
  adjustment.first_variable = std::max(0, keyframe_count() - options_.local_window);
  adjustment.robust_px = options_.robust_px;
  adjustment.max_iterations = kWindowIterations;
  adjustment.function_tolerance = 1e-4;
  adjustment.threads = options_.threads;
  adjuster_.begin(camera_, adjustment, scene_);
}

void Segment::take_over_adjustment() {
  const bool again = adjuster_.wanted_again();
  std::vector<Pose> before;
  for (const Keyframe& keyframe : scene_.keyframes) before.push_back(keyframe.eye_from_scene);
  const AdjustmentWindow window = adjuster_.take();
  take_over(window, scene_);
  carry_along(before, scene_, frames_);
  judge_observations(camera_, point_options(options_),
                     window.first_keyframe + window.options.first_variable, scene_);
  thin_keyframes();
  if (again) begin_adjustment();
}

void Segment::thin_keyframes() {
  while (const auto spare =
             keyframe_to_spare(scene_, options_.max_keyframes, options_.local_window)) {
    const Keyframe& keyframe = scene_.keyframes[static_cast<std::size_t>(*spare)];
    frames_.find(keyframe.frame_index)->keyframe = false;
    scene_.remove_keyframe(*spare);
  }
}

void Segment::settle() {
  while (adjuster_.under_way()) take_over_adjustment();
}

void Segment::finish() {
  settle();
  if (!started()) return;
  adjust_finally(camera_, options_, scene_);
  refresh_frames();
}

void Segment::refresh_rays() {
  settle();
  scene_.refresh_rays(camera_);
}

}  // namespace handeye
