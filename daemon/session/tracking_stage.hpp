// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "daemon/session/image_stage.hpp"

namespace handeye {

/// Finds the field of view where no mask was given, then tracks features.
class TrackingStage final : public ImageStage {
 public:
  /// `mask`: CV_8UC1, 255 = usable; empty: it is found in the first images.
  explicit TrackingStage(cv::Mat mask);

 private:
  void look(const Frame& frame, TrackedFrame& tracked) override;
  void find_mask(const cv::Mat& grey);

  std::unique_ptr<FeatureTracker> tracker_;
  cv::Mat mask_;
  int mask_attempts_left_{0};
};

}  // namespace handeye
