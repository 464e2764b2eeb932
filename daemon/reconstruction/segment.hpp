// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/resection.hpp"
#include "daemon/reconstruction/scene.hpp"
#include "daemon/reconstruction/start_search.hpp"

namespace handeye {

/// One connected part of the reconstruction: from its start to the loss of tracking. It has one
/// scale.
class Segment {
 public:
  Segment(const CameraModel& camera, const ReconstructionOptions& options);

  /// Takes the next frame: searches for a start, or registers it and perhaps makes it a keyframe.
  ReconstructionState add(FrameRecord frame);

  /// Tracking is lost for good: the last frames could not be registered, nor will the next.
  bool lost() const;

  /// Hands over the frames at the end that could not be registered: the next part begins with them.
  std::vector<FrameRecord> take_lost_frames();

  /// Adjusts all keyframes and points until nothing changes and registers all other frames again.
  void finish();

  /// To be called when the camera it was given has changed.
  void refresh_rays() { scene_.refresh_rays(camera_); }

  bool started() const { return !scene_.keyframes.empty(); }
  int keyframe_count() const { return static_cast<int>(scene_.keyframes.size()); }
  int registered_count() const { return registered_; }

  /// Its registered frames, points and error.
  Reconstruction result() const;

 private:
  ReconstructionState search_start();
  void adopt(Scene scene);
  bool register_frame(FrameRecord& frame, const Pose& predicted);
  Pose predict() const;
  bool wants_keyframe(const FrameRecord& frame) const;
  void insert_keyframe(FrameRecord& frame);
  void thin_keyframes();
  void adjust_window();
  void adjust_all();
  void refresh_frames();
  const FrameRecord* find_frame(std::int64_t index) const;
  FrameRecord* find_frame(std::int64_t index);

  const CameraModel& camera_;
  const ReconstructionOptions& options_;
  StartSearch search_;
  Scene scene_;
  std::vector<FrameRecord> frames_;
  std::vector<PointMatch> matches_;  ///< scratch
  int registered_{0};
  int misses_{0};            ///< frames in a row that could not be registered
  int keyframe_inliers_{0};  ///< of the last keyframe
};

}  // namespace handeye
