// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "daemon/tracking/feature_tracker.hpp"
#include "drivers/camera.hpp"

namespace handeye {

/// From images to tracked features, for one calibration: finds the field of view where no mask was
/// given, then tracks. The same in the live daemon and in a replay. One thread.
class TrackingStage {
 public:
  /// `mask`: CV_8UC1, 255 = usable; empty: it is found in the first images.
  explicit TrackingStage(cv::Mat mask);

  void process(const Frame& frame, TrackedFrame& tracked);

  /// Wall time spent so far [ms].
  double time_ms() const { return time_ms_; }

 private:
  void find_mask(const cv::Mat& grey);

  std::unique_ptr<FeatureTracker> tracker_;
  cv::Mat mask_;
  int mask_attempts_left_{0};
  double time_ms_{0};
};

}  // namespace handeye
