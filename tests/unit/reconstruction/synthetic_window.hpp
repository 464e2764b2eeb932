// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/geometry/pose.hpp"

namespace handeye::test {

/// A cloud of points seen from some cameras around it, all by all.
struct WindowOptions {
  int frames{15};
  int points{60};
  double relief{0.15};   ///< half the depth of the cloud, in units of its distance
  double sweep_deg{10};  ///< turn about the cloud's centre from the first frame to the last
  double width{0.35};    ///< half the width of the cloud, in units of its distance
  double noise_px{0.3};  ///< per axis, at a focal length of 600 px
  unsigned seed{1};
};

struct SyntheticWindow {
  Eigen::MatrixXd rays;         ///< 2F x P, as for `factorise`
  Eigen::MatrixXd affine_rays;  ///< the same scene as a paraperspective camera sees it, no noise
  std::vector<Pose> eye_from_scene;  ///< origin in the centroid of the points
  Eigen::Matrix3Xd points_scene;
};

inline constexpr double kWindowFocalPx = 600.0;

SyntheticWindow make_window(const WindowOptions& options);

/// Largest difference of the relative rotations to the first frame, found against true [deg].
double largest_rotation_error_deg(const std::vector<Pose>& found, const std::vector<Pose>& truth);

}  // namespace handeye::test
