// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/appearances.hpp"
#include "daemon/reconstruction/frame_history.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/relocalisation.hpp"
#include "daemon/reconstruction/resection.hpp"
#include "daemon/reconstruction/scene.hpp"
#include "daemon/reconstruction/start_search.hpp"
#include "daemon/reconstruction/window_adjuster.hpp"

namespace handeye {

/// One connected part of the reconstruction, with one scale: from its start to the loss of
/// tracking, and on from where it is found again.
class Segment {
 public:
  /// All three must outlive it; the thread is used by one segment at a time.
  Segment(const CameraModel& camera, const ReconstructionOptions& options,
          AdjustmentThread& thread);

  /// Takes the next frame: searches for a start, or registers it and perhaps makes it a keyframe.
  ReconstructionState add(FrameRecord frame, const Appearances& appearances);

  /// Tracking is lost: the last frames could not be registered, nor will the next by their
  /// features.
  bool lost() const;

  /// Hands over the frames at the end that could not be registered, or, where nothing has started,
  /// those that may help the next part to start.
  FrameHistory::Frames take_lost_frames();
  FrameHistory::Frames take_all_frames();

  /// Finds a frame in this part's scene by what its features look like.
  std::optional<Relocalisation> find(const FrameRecord& frame,
                                     const Appearances& appearances) const;

  /// Goes on after a loss: the last of the frames was found again, those before it followed the
  /// loss and are registered backwards from it as far as that goes.
  void resume(FrameHistory::Frames frames, const Relocalisation& found,
              const Appearances& appearances);

  /// Takes over what the thread is still adjusting.
  void settle();

  /// Adjusts all keyframes and points and registers all other frames again.
  void finish();

  /// To be called when the camera it was given has changed.
  void refresh_rays();

  bool started() const { return !scene_.keyframes.empty(); }
  const FrameRecord& newest_frame() const { return frames_.newest(); }
  int frame_count() const { return frames_.count(); }
  int keyframe_count() const { return static_cast<int>(scene_.keyframes.size()); }
  int registered_count() const { return registered_; }

  /// Its registered frames, points and error.
  Reconstruction result() const;

 private:
  ReconstructionState search_start(const Appearances& appearances);
  void adopt(Scene scene, const Appearances& appearances);
  bool register_frame(FrameRecord& frame, const Pose& predicted);
  bool wants_keyframe(const FrameRecord& frame) const;
  void insert_keyframe(FrameRecord& frame, const Appearances& appearances);
  void begin_adjustment();
  void take_over_adjustment();
  void thin_keyframes();
  void refresh_frames();
  void register_backwards(int count);
  std::vector<ScenePoint> structure(const std::vector<int>& frame_of_keyframe) const;

  const CameraModel& camera_;
  const ReconstructionOptions& options_;
  WindowAdjuster adjuster_;
  std::optional<StartSearch> search_;
  Scene scene_;
  FrameHistory frames_;
  std::vector<PointMatch> matches_;  ///< scratch
  int registered_{0};
  int misses_{0};            ///< frames in a row that could not be registered
  int keyframe_inliers_{0};  ///< of the last keyframe
};

}  // namespace handeye
