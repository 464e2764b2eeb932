// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "drivers/simulator/motion.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

constexpr double kFarMm = 2000.0;
const CameraModel kCamera{640, 480, 603, 601, 324.3, 236.1, {-0.1, 0.02, 0, 0, 0}};

Pose surface_from_eye_at(const Surface& surface, MotionKind kind, double time_s) {
  MotionOptions options;
  options.kind = kind;
  return Motion(21, {0, 0, surface.height(0, 0)}, options).surface_from_eye(time_s);
}

/// The surface point that a pixel sees, in double precision and by the slow way.
Eigen::Vector3d surface_point(const Surface& surface, const Pose& surface_from_eye,
                              const Eigen::Vector2d& pixel, const CameraModel& camera = kCamera) {
  const Eigen::Vector3d direction =
      surface_from_eye.linear() * unproject(camera, pixel).value().homogeneous();
  const Eigen::Vector3d origin = surface_from_eye.translation();
  return origin + surface.intersect(origin, direction, kFarMm).value() * direction;
}

/// How far the renderer's depths are from what the slow way finds, over an image.
struct DepthErrors {
  double largest_mm{0}, largest_px{0};
};

DepthErrors depth_errors(const Surface& surface, const Pose& surface_from_eye,
                         const CameraModel& camera, const cv::Mat1f& depth_mm) {
  DepthErrors errors;
  for (int row = 0; row < camera.height; row += 7) {
    for (int column = 0; column < camera.width; column += 5) {
      const Eigen::Vector2d pixel(column, row);
      const Eigen::Vector3d truth = surface_point(surface, surface_from_eye, pixel, camera);
      const Eigen::Vector3d in_eye = static_cast<double>(depth_mm(row, column)) *
                                     unproject(camera, pixel).value().homogeneous();
      const Eigen::Vector3d truth_in_eye = surface_from_eye.inverse() * truth;
      errors.largest_mm = std::max(errors.largest_mm, (in_eye - truth_in_eye).norm());
      errors.largest_px =
          std::max(errors.largest_px, (project<double>(camera, truth_in_eye) - pixel).norm());
    }
  }
  return errors;
}

TEST(Renderer, MeetsTheSurfaceWhereTheSlowWayDoes) {
  const Surface surface(5);
  Renderer renderer(surface, kCamera, 5);
  cv::Mat grey;
  for (const auto kind : {MotionKind::kFree, MotionKind::kRotation, MotionKind::kPivot}) {
    for (const double time_s : {0.0, 3.1, 7.7, 12.9, 18.4}) {
      const Pose surface_from_eye = surface_from_eye_at(surface, kind, time_s);
      renderer.render(surface_from_eye, 0, grey);
      const auto errors = depth_errors(surface, surface_from_eye, kCamera, renderer.depth_mm());
      EXPECT_LT(errors.largest_mm, 0.01) << motion_name(kind) << " at " << time_s << " s";
      EXPECT_LT(errors.largest_px, 1e-3) << motion_name(kind) << " at " << time_s << " s";
    }
  }
}

TEST(Renderer, MeetsTheSurfaceThroughAStrongLensAndWithoutTexture) {
  CameraModel camera = kCamera;
  camera.distortion = {-0.3, 0, 0, 0, 0};
  for (const auto scene : {SceneKind::kPlane, SceneKind::kBare}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const Surface surface(seed, scene);
      Renderer renderer(surface, camera, seed);
      cv::Mat grey;
      for (double time_s = 0; time_s < 20; time_s += 1.7) {
        const Pose surface_from_eye = surface_from_eye_at(surface, MotionKind::kFree, time_s);
        renderer.render(surface_from_eye, 0, grey);
        const auto errors = depth_errors(surface, surface_from_eye, camera, renderer.depth_mm());
        EXPECT_LT(errors.largest_mm, 0.01) << scene_name(scene) << " at " << time_s << " s";
        EXPECT_LT(errors.largest_px, 1e-3) << scene_name(scene) << " at " << time_s << " s";
      }
    }
  }
}

TEST(Renderer, BareHillsAreShadedButNotTextured) {
  const auto roughness = [](SceneKind scene) {
    const Surface surface(3, scene);
    ImagingOptions noiseless;
    noiseless.noise_grey = 0;
    Renderer renderer(surface, kCamera, 3, noiseless);
    cv::Mat grey;
    renderer.render(surface_from_eye_at(surface, MotionKind::kFree, 1.0), 0, grey);
    EXPECT_GT(cv::mean(grey)[0], 60.0);
    return cv::norm(grey.colRange(1, grey.cols), grey.colRange(0, grey.cols - 1), cv::NORM_L1) /
           static_cast<double>(grey.total());
  };
  EXPECT_LT(roughness(SceneKind::kBare), 0.3);
  EXPECT_GT(roughness(SceneKind::kPlane), 2.0);
  EXPECT_GT(roughness(SceneKind::kTissue), 2.0);
}

/// Cubic convolution (Catmull-Rom) of four samples at fraction 0..1 between the middle two.
double cubic(const std::array<double, 4>& v, double fraction) {
  const double slope = 0.5 * (v[2] - v[0]);
  const double square = v[0] - 2.5 * v[1] + 2.0 * v[2] - 0.5 * v[3];
  const double cube = 0.5 * (v[3] - v[0]) + 1.5 * (v[1] - v[2]);
  return v[1] + fraction * (slope + fraction * (square + fraction * cube));
}

double interpolate(const cv::Mat1b& image, const Eigen::Vector2d& pixel) {
  const auto column = static_cast<int>(std::floor(pixel.x()));
  const auto row = static_cast<int>(std::floor(pixel.y()));
  std::array<double, 4> rows{};
  for (int i = 0; i < 4; ++i) {
    const std::uint8_t* values = image[row - 1 + i] + column - 1;
    rows[static_cast<std::size_t>(i)] =
        cubic({static_cast<double>(values[0]), static_cast<double>(values[1]),
               static_cast<double>(values[2]), static_cast<double>(values[3])},
              pixel.x() - column);
  }
  return cubic(rows, pixel.y() - row);
}

/// Where the patch around `pixel` of the second view lies beside the place that geometry says, by
/// least squares over shift, gain and a plane of brightness. Nothing where the patch leaves the
/// first view.
std::optional<Eigen::Vector2d> patch_shift_px(const Surface& surface, const cv::Mat1b& first,
                                              const Pose& surface_from_first,
                                              const cv::Mat1b& second,
                                              const Pose& surface_from_second,
                                              const Eigen::Vector2i& pixel) {
  constexpr int kRadius = 10;
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right_side = Vector6d::Zero();
  for (int row = pixel.y() - kRadius; row <= pixel.y() + kRadius; ++row) {
    for (int column = pixel.x() - kRadius; column <= pixel.x() + kRadius; ++column) {
      const Eigen::Vector3d point =
          surface_point(surface, surface_from_second, Eigen::Vector2d(column, row));
      const Eigen::Vector3d in_first = surface_from_first.inverse() * point;
      const Eigen::Vector2d seen_at = project<double>(kCamera, in_first);
      if (seen_at.x() < 2 || seen_at.y() < 2 || seen_at.x() > kCamera.width - 3 ||
          seen_at.y() > kCamera.height - 3) {
        return std::nullopt;
      }
      const double gradient_x = 0.5 * (second(row, column + 1) - second(row, column - 1));
      const double gradient_y = 0.5 * (second(row + 1, column) - second(row - 1, column));
      Vector6d equation;
      equation << gradient_x, gradient_y, interpolate(first, seen_at), 1.0, column - pixel.x(),
          row - pixel.y();
      normal += equation * equation.transpose();
      right_side += equation * static_cast<double>(second(row, column));
    }
  }
  const Vector6d solution = normal.ldlt().solve(right_side);
  return Eigen::Vector2d(solution.head<2>());
}

TEST(Renderer, TextureShowsWhereProjectionSays) {
  const Surface surface(17);
  ImagingOptions noiseless;
  noiseless.noise_grey = 0;
  Renderer renderer(surface, kCamera, 17, noiseless);
  const Pose surface_from_first = surface_from_eye_at(surface, MotionKind::kFree, 2.0);
  const Pose surface_from_second = surface_from_eye_at(surface, MotionKind::kFree, 2.7);
  cv::Mat first;
  cv::Mat second;
  renderer.render(surface_from_first, 0, first);
  renderer.render(surface_from_second, 1, second);

  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double mean_length = 0;
  int patches = 0;
  for (int row = 30; row < kCamera.height - 20; row += 45) {
    for (int column = 30; column < kCamera.width - 20; column += 45) {
      const auto shift = patch_shift_px(surface, first, surface_from_first, second,
                                        surface_from_second, {column, row});
      if (!shift) continue;
      mean += *shift;
      mean_length += shift->norm();
      ++patches;
    }
  }
  ASSERT_GT(patches, 50);
  EXPECT_LT(mean.norm() / patches, 0.005);
  EXPECT_LT(mean_length / patches, 0.02);
}

TEST(Renderer, SameFrameSameBytesOtherFrameOtherNoise) {
  const Surface surface(2);
  Renderer renderer(surface, kCamera, 2);
  Renderer another(surface, kCamera, 2);
  const Pose surface_from_eye = surface_from_eye_at(surface, MotionKind::kFree, 1.0);
  cv::Mat seventh;
  cv::Mat eighth;
  cv::Mat seventh_again;
  renderer.render(surface_from_eye, 7, seventh);
  renderer.render(surface_from_eye, 8, eighth);
  another.render(surface_from_eye, 7, seventh_again);
  EXPECT_EQ(cv::norm(seventh, seventh_again, cv::NORM_INF), 0.0);

  cv::Mat difference;
  cv::subtract(seventh, eighth, difference, cv::noArray(), CV_32F);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(difference, mean, deviation);
  EXPECT_NEAR(mean[0], 0.0, 0.05);
  EXPECT_NEAR(deviation[0], std::sqrt(2.0) * ImagingOptions{}.noise_grey, 0.15);
}

TEST(Renderer, IsLitFromTheTip) {
  const Surface surface(2);
  Renderer renderer(surface, kCamera, 2);
  Pose surface_from_eye = surface_from_eye_at(surface, MotionKind::kStatic, 0.0);
  cv::Mat near_image;
  cv::Mat far_image;
  surface_from_eye.translation().z() = 65;
  renderer.render(surface_from_eye, 0, near_image);
  surface_from_eye.translation().z() = 110;
  renderer.render(surface_from_eye, 0, far_image);
  EXPECT_GT(cv::mean(near_image)[0], 1.3 * cv::mean(far_image)[0]);
  // Exposed as a camera head would: neither black nor clipped.
  EXPECT_GT(cv::mean(far_image)[0], 40.0);
  EXPECT_LT(cv::countNonZero(near_image == 255), static_cast<int>(near_image.total() / 100));
}

TEST(Renderer, RefusesALensThatCannotBeInverted) {
  const Surface surface(2);
  CameraModel camera = kCamera;
  camera.distortion[0] = -2.0;
  EXPECT_THROW(Renderer(surface, camera, 1), UsageError);
}

}  // namespace
}  // namespace handeye::simulator
