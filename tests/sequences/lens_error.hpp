// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

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
/// `field_of_view`: CV_8UC1 of that size, 0 where the scope shows nothing: what a lens does there
/// no image can tell, and nobody will ask. Empty: the whole image counts.
LensError lens_error(const CameraModel& truth, const CameraModel& estimate,
                     const cv::Mat& field_of_view = {});

}  // namespace handeye::sequences
