// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/tracking_stage.hpp"

#include <utility>

namespace handeye {

TrackingStage::TrackingStage(cv::Mat mask, const std::optional<CameraModel>& lens)
    : field_of_view_(std::move(mask)), tracker_(make_feature_tracker({.lens = lens})) {}

void TrackingStage::look(const cv::Mat& grey, std::int64_t timestamp_ns, TrackedFrame& tracked) {
  const cv::Mat& field = field_of_view_.look(grey);
  const cv::Mat& usable = highlights_.usable(grey, field);
  tracker_->track(grey, usable, timestamp_ns, tracked);
}

}  // namespace handeye
