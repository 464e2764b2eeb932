// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/reconstruction/synthetic_window.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace handeye::test {

SyntheticWindow make_window(const WindowOptions& options) {
  std::mt19937 random(options.seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, options.noise_px / kWindowFocalPx);
  SyntheticWindow window;
  window.points_scene.resize(3, options.points);
  for (Eigen::Index p = 0; p < window.points_scene.cols(); ++p) {
    const double x = options.width * uniform(random);
    const double y = options.width * uniform(random);
    window.points_scene.col(p) << x, y, options.relief * uniform(random);
  }
  window.points_scene.colwise() -= window.points_scene.rowwise().mean().eval();

  // Turns about an axis across the view that itself turns on, the gaze and the distance wander.
  const double axis_rad = kPi * uniform(random);
  window.rays.resize(2 * options.frames, options.points);
  window.affine_rays.resize(2 * options.frames, options.points);
  for (int f = 0; f < options.frames; ++f) {
    const double t = static_cast<double>(f) / (options.frames - 1);
    const double sweep_rad = rad_from_deg(options.sweep_deg);
    const Eigen::Vector3d along(std::cos(axis_rad), std::sin(axis_rad), 0.2);
    const Eigen::Vector3d across(-std::sin(axis_rad), std::cos(axis_rad), 0.1);
    Pose pose = Pose::Identity();
    pose.linear() = exp_so3(sweep_rad * (t * along + 0.3 * std::sin(kPi * t) * across));
    pose.translation() = Eigen::Vector3d(0.05 * std::sin(5.0 * t), 0.05 * std::cos(4.0 * t),
                                         1.0 + 0.1 * std::sin(3.0 * t));
    window.eye_from_scene.push_back(pose);
    const Eigen::Matrix3Xd eye = pose * window.points_scene;
    const Eigen::Vector2d centroid = pose.translation().hnormalized();
    for (Eigen::Index p = 0; p < eye.cols(); ++p) {
      const Eigen::Vector2d ray = eye.col(p).hnormalized();
      window.rays.col(p).segment<2>(2 * f) = ray + Eigen::Vector2d(noise(random), noise(random));
      const Eigen::Vector3d s = pose.linear() * window.points_scene.col(p);
      window.affine_rays.col(p).segment<2>(2 * f) =
          centroid + (s.head<2>() - s.z() * centroid) / pose.translation().z();
    }
  }
  return window;
}

double largest_rotation_error_deg(const std::vector<Pose>& found, const std::vector<Pose>& truth) {
  double largest = 0.0;
  for (std::size_t f = 0; f < found.size(); ++f) {
    const Eigen::Matrix3d relative = found[f].linear() * found.front().linear().transpose();
    const Eigen::Matrix3d expected = truth[f].linear() * truth.front().linear().transpose();
    largest = std::max(largest, deg_from_rad(rotation_angle_rad(relative, expected)));
  }
  return largest;
}

}  // namespace handeye::test
