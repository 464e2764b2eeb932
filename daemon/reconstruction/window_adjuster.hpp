// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/reconstruction/adjustment_thread.hpp"
#include "daemon/reconstruction/adjustment_window.hpp"

namespace handeye {

/// Adjusts a scene's newest keyframes while frames keep coming. A window is cut out when a keyframe
/// is made and taken over a fixed number of frames later, however long the thread took: live and
/// replayed, on a slow machine and a fast one, the same frames give the same scene, bit for bit.
class WindowAdjuster {
 public:
  /// `background` false: the work is done where it is waited for, which changes nothing but time.
  WindowAdjuster(AdjustmentThread& thread, bool background)
      : thread_(thread), background_(background) {}
  ~WindowAdjuster();
  WindowAdjuster(const WindowAdjuster&) = delete;
  WindowAdjuster& operator=(const WindowAdjuster&) = delete;

  /// Cuts a window out and begins; while one is being adjusted, remembers that another is wanted.
  void begin(const CameraModel& camera, const AdjustmentOptions& options, const Scene& scene);

  /// Counts a frame; true: it is time to `take`.
  bool count_frame();

  bool under_way() const { return window_.has_value(); }
  bool wanted_again() const { return wanted_again_; }

  /// The adjusted window; waits for it. To be called only while one is under way.
  AdjustmentWindow take();

 private:
  AdjustmentThread& thread_;
  bool background_;
  std::optional<AdjustmentWindow> window_;
  bool wanted_again_{false};
  int frames_{0};  ///< since it was cut out
};

}  // namespace handeye
