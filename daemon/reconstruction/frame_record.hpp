// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/tracking/feature_tracker.hpp"

namespace handeye {

/// An observation as it is kept for every frame: 16 bytes.
struct FrameObservation {
  std::int64_t feature_id{0};
  float x{0}, y{0};  ///< px
};

/// What is remembered of a frame, keyframe or not.
struct FrameRecord {
  std::int64_t index{0};  ///< TrackedFrame::index
  std::int64_t timestamp_ns{0};
  std::vector<FrameObservation> observations;  ///< ordered by feature_id
  std::optional<Pose> eye_from_scene;          ///< nothing while not registered
  bool keyframe{false};
  double reprojection_px{0};
  int inliers{0};
  Matrix6d unit_covariance{Matrix6d::Zero()};  ///< as RegisteredFrame's
};

FrameRecord make_record(const TrackedFrame& frame);

/// Where one feature is in two frames [px].
struct PixelPair {
  Eigen::Vector2d first;
  Eigen::Vector2d second;
};

/// The features that both frames show, ordered by feature_id.
std::vector<PixelPair> common_features(const FrameRecord& first, const FrameRecord& second);

/// Median movement of the features common to two frames, in px at kReferenceFocalPx; 0 for none.
double median_movement_px(const CameraModel& camera, const std::vector<PixelPair>& pairs);

}  // namespace handeye
