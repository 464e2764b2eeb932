// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/tracking_stage.hpp"

#include <utility>

#include "daemon/tracking/field_of_view.hpp"

namespace handeye {
namespace {

// The first images may be dark while the camera settles its exposure.
constexpr int kMaskAttempts = 10;

}  // namespace

TrackingStage::TrackingStage(cv::Mat mask)
    : tracker_(make_feature_tracker()),
      mask_(std::move(mask)),
      mask_attempts_left_(mask_.empty() ? kMaskAttempts : 0) {}

void TrackingStage::look(const Frame& frame, TrackedFrame& tracked) {
  find_mask(frame.grey);
  tracker_->track(frame.grey, mask_, frame.timestamp_ns, tracked);
}

void TrackingStage::find_mask(const cv::Mat& grey) {
  if (mask_attempts_left_ == 0 || !mask_.empty()) return;
  --mask_attempts_left_;
  mask_ = find_field_of_view(grey);
}

}  // namespace handeye
