// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "daemon/session/image_stage.hpp"
#include "daemon/tracking/field_of_view.hpp"
#include "daemon/tracking/highlights.hpp"

namespace handeye {

/// Finds the field of view where no mask was given, leaves the highlights out, tracks features in
/// the rest.
class TrackingStage final : public ImageStage {
 public:
  /// `mask`: CV_8UC1, 255 = usable; empty: it is found in the images. `lens`: where it is known.
  explicit TrackingStage(cv::Mat mask, const std::optional<CameraModel>& lens = {});

 private:
  void look(const cv::Mat& grey, std::int64_t timestamp_ns, TrackedFrame& tracked) override;

  FieldOfView field_of_view_;
  Highlights highlights_;
  std::unique_ptr<FeatureTracker> tracker_;
};

}  // namespace handeye
