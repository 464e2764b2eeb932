// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/tracking/patch.hpp"

namespace handeye {

/// Of the same camera's images with their sides halved so many times.
CameraModel halved(CameraModel lens, int halvings);

/// A window that an appearance was taken of, as rays (x/z, y/z) through a lens.
struct WindowRays {
  Eigen::Vector2d middle;
  std::array<Eigen::Vector2d, 4> around;  ///< left, right, above, below
  Eigen::Matrix2d pixel_by_ray;           ///< at the middle
};

/// Nothing where the lens does not reach.
std::optional<WindowRays> window_rays(const CameraModel& lens, const Eigen::Vector2d& middle_px);

/// By how much an affine fit misses the window's middle [px of the image that it was found in],
/// because the lens bent the window differently in the two images: subtract it. Zero where the lens
/// does not reach.
///
/// To second order the window has moved by w(d) = w(0) + L d + d'H d / 2, and an affine fit finds
/// w(0) + m (H_xx + H_yy) / 2 for its middle, with m the second moment of where its texture lies.
/// A radial lens, x(1 + k1 r^2), makes that about 4 m k1 / f^2 (s^2 p - s R p0) of the distances
/// from the centre now, p, and then, p0, of a window that has grown by s and turned by R: as if the
/// focal length was another. With k1 = -0.3, f = 450 px it is 0.05 px at the rim, for all windows
/// alike, and moves hand_from_eye by 0.1 mm, twice what 20 s of tracking leave otherwise.
Eigen::Vector2d bend_px(const CameraModel& lens, const WindowRays& taken, const AffineWarp& found);

}  // namespace handeye
