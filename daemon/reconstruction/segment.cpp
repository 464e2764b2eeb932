// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/segment.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/reconstruction/bundle_adjustment.hpp"
#include "daemon/reconstruction/scene_points.hpp"

namespace handeye {
namespace {

/// Frames in a row without a pose after which the part is given up: occlusions this short are
/// bridged as long as the features survive them.
constexpr int kMaxMisses = 5;
/// A frame that sees less than this share of the last keyframe's points becomes a keyframe itself.
constexpr double kKeyframeInlierRatio = 0.7;
constexpr int kWindowIterations = 6;
constexpr int kMaxRounds = 4;

ResectionOptions resection_options(const ReconstructionOptions& options) {
  return {options.max_reprojection_px, options.robust_px, options.min_resection_inliers,
          options.min_resection_ratio};
}

PointOptions point_options(const ReconstructionOptions& options) {
  return {options.max_reprojection_px, options.min_triangulation_deg};
}

}  // namespace

Segment::Segment(const CameraModel& camera, const ReconstructionOptions& options)
    : camera_(camera), options_(options), search_(camera, options) {}

ReconstructionState Segment::add(FrameRecord frame) {
  frames_.push_back(std::move(frame));
  if (!started()) return search_start();
  FrameRecord& newest = frames_.back();
  if (!register_frame(newest, predict())) {
    ++misses_;
    return ReconstructionState::kTracking;
  }
  misses_ = 0;
  if (wants_keyframe(newest)) {
    insert_keyframe(newest);
    adjust_window();
    thin_keyframes();
  }
  return ReconstructionState::kTracking;
}

bool Segment::lost() const {
  if (started()) return misses_ >= kMaxMisses;
  if (frames_.size() < 2) return false;
  const auto common = common_features(frames_[frames_.size() - 2], frames_.back());
  return static_cast<int>(common.size()) < options_.min_common_features;
}

std::vector<FrameRecord> Segment::take_lost_frames() {
  const int count = started() ? misses_ : 1;
  const auto first = frames_.end() - count;
  std::vector<FrameRecord> lost(std::make_move_iterator(first),
                                std::make_move_iterator(frames_.end()));
  frames_.erase(first, frames_.end());
  misses_ = 0;
  return lost;
}

ReconstructionState Segment::search_start() {
  StartAttempt attempt = search_.look(frames_);
  if (attempt.scene) adopt(std::move(*attempt.scene));
  return attempt.state;
}

/// Takes the started scene over and registers all frames so far, outwards from those it has.
void Segment::adopt(Scene scene) {
  scene_ = std::move(scene);
  for (std::size_t k = 0; k < scene_.keyframes.size(); ++k) {
    Keyframe& keyframe = scene_.keyframes[k];
    FrameRecord& frame = *find_frame(keyframe.frame_index);
    register_frame(frame, keyframe.eye_from_scene);
    frame.eye_from_scene = keyframe.eye_from_scene;
    frame.keyframe = true;
    keyframe_inliers_ = frame.inliers;
    if (k == 0) continue;
    const Keyframe& before = scene_.keyframes[k - 1];
    keyframe.travel_px =
        before.travel_px +
        median_movement_px(camera_, common_features(*find_frame(before.frame_index), frame));
  }
  refresh_frames();
}

const FrameRecord* Segment::find_frame(std::int64_t index) const {
  const auto found = std::lower_bound(
      frames_.begin(), frames_.end(), index,
      [](const FrameRecord& frame, std::int64_t wanted) { return frame.index < wanted; });
  return found != frames_.end() && found->index == index ? &*found : nullptr;
}

FrameRecord* Segment::find_frame(std::int64_t index) {
  const FrameRecord* found = std::as_const(*this).find_frame(index);
  return found != nullptr ? &frames_[static_cast<std::size_t>(found - frames_.data())] : nullptr;
}

/// Constant velocity, by the index of the frames, from the last two that are registered.
Pose Segment::predict() const {
  const FrameRecord* last = nullptr;
  for (auto frame = frames_.rbegin() + 1; frame != frames_.rend(); ++frame) {
    if (!frame->eye_from_scene) continue;
    if (last == nullptr) {
      last = &*frame;
      continue;
    }
    const double ahead = static_cast<double>(frames_.back().index - frame->index) /
                         static_cast<double>(last->index - frame->index);
    return interpolate(*frame->eye_from_scene, *last->eye_from_scene, std::min(ahead, 3.0));
  }
  return last != nullptr ? *last->eye_from_scene : Pose::Identity();
}

bool Segment::register_frame(FrameRecord& frame, const Pose& predicted) {
  scene_.find_matches(frame, matches_);
  const auto resected = resect(camera_, matches_, predicted, resection_options(options_));
  registered_ += (resected ? 1 : 0) - (frame.eye_from_scene ? 1 : 0);
  frame.eye_from_scene.reset();
  if (!resected) return false;
  frame.eye_from_scene = resected->eye_from_scene;
  frame.inliers = resected->inliers;
  frame.reprojection_px = resected->reprojection_px;
  return true;
}

bool Segment::wants_keyframe(const FrameRecord& frame) const {
  if (frame.inliers < kKeyframeInlierRatio * keyframe_inliers_) return true;
  const Keyframe& last = scene_.keyframes.back();
  const FrameRecord* before = find_frame(last.frame_index);
  return median_movement_px(camera_, common_features(*before, frame)) >=
         options_.keyframe_parallax_px;
}

void Segment::insert_keyframe(FrameRecord& frame) {
  const Keyframe& last = scene_.keyframes.back();
  const double movement_px =
      median_movement_px(camera_, common_features(*find_frame(last.frame_index), frame));
  scene_.add_keyframe(camera_, frame, *frame.eye_from_scene, last.travel_px + movement_px);
  frame.keyframe = true;
  keyframe_inliers_ = frame.inliers;
  const int newest = keyframe_count() - 1;
  triangulate_tracks(camera_, point_options(options_), newest, scene_);
  judge_observations(camera_, point_options(options_), newest, scene_);
}

/// Gives up the keyframe whose neighbours are nearest to each other, first and window apart.
void Segment::thin_keyframes() {
  if (keyframe_count() <= options_.max_keyframes) return;
  int weakest = -1;
  double smallest_px = 0.0;
  for (int k = 1; k < keyframe_count() - options_.local_window; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double gap_px = scene_.keyframes[i + 1].travel_px - scene_.keyframes[i - 1].travel_px;
    if (weakest < 0 || gap_px < smallest_px) {
      weakest = k;
      smallest_px = gap_px;
    }
  }
  if (weakest < 0) return;
  find_frame(scene_.keyframes[static_cast<std::size_t>(weakest)].frame_index)->keyframe = false;
  scene_.remove_keyframe(weakest);
}

void Segment::adjust_window() {
  AdjustmentOptions adjustment;
  adjustment.first_variable = std::max(0, keyframe_count() - options_.local_window);
  adjustment.robust_px = options_.robust_px;
  adjustment.max_iterations = kWindowIterations;
  adjustment.function_tolerance = 1e-4;
  adjustment.threads = options_.threads;
  adjust(camera_, adjustment, scene_);
  judge_observations(camera_, point_options(options_), adjustment.first_variable, scene_);
  for (int k = adjustment.first_variable; k < keyframe_count(); ++k) {
    const Keyframe& keyframe = scene_.keyframes[static_cast<std::size_t>(k)];
    find_frame(keyframe.frame_index)->eye_from_scene = keyframe.eye_from_scene;
  }
}

void Segment::finish() {
  if (!started()) return;
  adjust_all();
  refresh_frames();
}

/// Adjustments of everything, with tracks won back and outliers dropped between them, until the
/// verdicts on the observations settle; the last one to full convergence.
void Segment::adjust_all() {
  AdjustmentOptions adjustment;
  adjustment.robust_px = options_.robust_px;
  adjustment.threads = options_.threads;
  for (int round = 0; round < kMaxRounds; ++round) {
    int changed = 0;
    for (int k = 1; k < keyframe_count(); ++k) {
      changed += triangulate_tracks(camera_, point_options(options_), k, scene_);
    }
    changed += judge_observations(camera_, point_options(options_), 0, scene_);
    const bool last = round > 0 && (changed < 5 || round + 1 == kMaxRounds);
    adjustment.max_iterations = last ? 50 : 15;
    adjustment.function_tolerance = last ? 1e-9 : 1e-5;
    adjust(camera_, adjustment, scene_);
    if (last) break;
  }
  judge_observations(camera_, point_options(options_), 0, scene_);
}

/// Poses of all frames from the points as they are now: keyframes keep the adjusted ones, the
/// others start from their nearest registered neighbour, forwards and then backwards.
void Segment::refresh_frames() {
  for (const Keyframe& keyframe : scene_.keyframes) {
    FrameRecord& frame = *find_frame(keyframe.frame_index);
    register_frame(frame, keyframe.eye_from_scene);
    registered_ += frame.eye_from_scene ? 0 : 1;
    frame.eye_from_scene = keyframe.eye_from_scene;
  }
  const auto sweep = [this](auto begin, auto end, bool again) {
    const Pose* neighbour = nullptr;
    for (auto frame = begin; frame != end; ++frame) {
      if (!frame->keyframe && (again || !frame->eye_from_scene) && neighbour != nullptr) {
        register_frame(*frame, frame->eye_from_scene.value_or(*neighbour));
      }
      if (frame->eye_from_scene) neighbour = &*frame->eye_from_scene;
    }
  };
  sweep(frames_.begin(), frames_.end(), true);
  sweep(frames_.rbegin(), frames_.rend(), false);
}

Reconstruction Segment::result() const {
  Reconstruction result;
  if (!started()) return result;
  result.state = ReconstructionState::kTracking;
  double sum = 0.0;
  double count = 0.0;
  for (const FrameRecord& frame : frames_) {
    if (!frame.eye_from_scene) continue;
    result.frames.push_back({.index = frame.index,
                             .timestamp_ns = frame.timestamp_ns,
                             .eye_from_scene = *frame.eye_from_scene,
                             .keyframe = frame.keyframe,
                             .reprojection_px = frame.reprojection_px,
                             .inliers = frame.inliers});
    sum += frame.inliers * frame.reprojection_px * frame.reprojection_px;
    count += frame.inliers;
  }
  result.points = scene_.point_count();
  result.reprojection_px = count > 0 ? std::sqrt(sum / count) : 0.0;
  return result;
}

}  // namespace handeye
