// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"

namespace handeye::simulator {

/// Spreads every point by a Gaussian; `sigma_px` 0 changes nothing.
void defocus(double sigma_px, cv::Mat1f& radiance);

/// What moves while the shutter is open is drawn out along its way: the mean of the picture at
/// instants spread evenly over the exposure, each made from the picture of mid-exposure by moving
/// every point as the surface there moves (true to the first order of the movement, a few pixels).
class MotionBlur {
 public:
  explicit MotionBlur(const CameraModel& camera);

  /// `radiance` and `depth_mm` as seen at mid-exposure; `begin_from_middle` and `end_from_middle`
  /// take eye coordinates of mid-exposure to those of the exposure's begin and end.
  void apply(const cv::Mat1f& depth_mm, const Pose& begin_from_middle, const Pose& end_from_middle,
             cv::Mat1f& radiance);

 private:
  void find_ways(const cv::Mat1f& depth_mm, const Pose& begin_from_middle,
                 const Pose& end_from_middle);

  CameraModel camera_;
  cv::Mat2f coarse_px_;  ///< way over the exposure at the nodes of a coarse grid
  cv::Mat2f way_px_;     ///< the same at every pixel
  cv::Mat2f from_px_;
  cv::Mat1f moved_, sum_;
};

}  // namespace handeye::simulator
