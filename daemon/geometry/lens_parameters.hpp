// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/intrinsics_mode.hpp"

namespace handeye {

/// What self-calibration may move of a lens. The focal length [px] is the mean of fx and fy, the
/// aspect a = (fy - fx) / (fx + fy), the centre in px, k1 and k2 OpenCV's. p1, p2, k3 stay as
/// given.
enum LensParameter : int { kFocal, kAspect, kCentreX, kCentreY, kK1, kK2, kLensParameters };

using LensVector = Eigen::Matrix<double, kLensParameters, 1>;  ///< indexed by LensParameter
using LensMatrix = Eigen::Matrix<double, kLensParameters, kLensParameters>;

LensVector lens_vector(const CameraModel& camera);

/// The camera with these parameters of the lens, all else as it was.
CameraModel with_lens(const CameraModel& camera, const LensVector& lens);

/// What is believed of a lens before the images are asked: independent normal distributions.
struct LensPrior {
  LensVector mean{LensVector::Zero()};
  LensVector sigma{LensVector::Ones()};
};

/// For kRefine: a calibration of this kind of lens, focal length within some 10 %, the centre
/// within 2.5 % of the diagonal. For kEstimate: an endoscope with square pixels, the centre near
/// the middle, the distortion that of lenses from fish-eye to none; the focal length is nearly
/// free. Without priors parallel views bend the scene like a bowl and pay with distortion (Wu,
/// Critical Configurations for Radial Distortion Self-Calibration, CVPR 2014).
LensPrior lens_prior(const CameraModel& camera, IntrinsicsMode mode);

/// A camera of which nothing is known but the size of its image, as first guess.
/// `horizontal_field_rad`: of view, without distortion.
CameraModel plain_camera(int width, int height, double horizontal_field_rad);

/// How far apart [px] two lenses see the same ray, the largest over the image of the first.
double largest_difference_px(const CameraModel& first, const CameraModel& second);

/// Standard deviation [px] of what the distortion moves a ray (x/z, y/z) by, by a covariance of the
/// parameters.
double distortion_sigma_px(const CameraModel& camera, const LensMatrix& covariance,
                           const Eigen::Vector2d& ray);

}  // namespace handeye
