// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/geometry/camera_model.hpp"

namespace handeye::sequences {

/// How far a camera that was estimated is from the true one.
struct LensError {
  /// The larger of fx and fy, relative to the truth [%].
  double focal_percent{0};
  /// Largest distance, over the image, between a pixel and where the estimated camera sends the
  /// ray that the true camera has there: everything together, focal length, centre and distortion.
  double ray_px{0};
  /// The same with focal lengths and centre of the estimate replaced by the true ones: what
  /// is wrong with the distortion alone.
  double distortion_px{0};
};

/// Over a grid of pixels that includes the image's corners. Both cameras have the same image size.
LensError lens_error(const CameraModel& truth, const CameraModel& estimate);

}  // namespace handeye::sequences
