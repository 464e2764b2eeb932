// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/planar_start.hpp"

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

namespace handeye {
namespace {

/// The plane of the object: its points have z = 0 in this frame.
Pose object_from_plane(const Observations& observations) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const ObservedPosition& position : observations.positions) {
    for (const ObjectPoint& point : position.points) mean += point.object_mm;
  }
  mean /= static_cast<double>(observations.point_count());
  for (const ObservedPosition& position : observations.positions) {
    for (const ObjectPoint& point : position.points) {
      scatter += (point.object_mm - mean) * (point.object_mm - mean).transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  Pose pose = Pose::Identity();
  pose.linear() << eigen.eigenvectors().col(2), eigen.eigenvectors().col(1),
      eigen.eigenvectors().col(2).cross(eigen.eigenvectors().col(1));
  pose.translation() = mean;
  return pose;
}

struct Zhang {
  Eigen::Matrix3d intrinsics_px{Eigen::Matrix3d::Identity()};
  double k1_of_normalised{0};  ///< OpenCV's
  std::vector<Pose> eye_from_plane;
};

Pose pose_of(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  const auto vector_of = [](const cv::Mat& m) {
    return Eigen::Vector3d(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(vector_of(rotation_vector));
  pose.translation() = vector_of(translation);
  return pose;
}

std::optional<Zhang> zhang(const Observations& observations, const Pose& plane_from_object,
                           bool distortion_inside) {
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> images;
  for (const ObservedPosition& position : observations.positions) {
    auto& object = objects.emplace_back();
    auto& image = images.emplace_back();
    for (const ObjectPoint& point : position.points) {
      const Eigen::Vector3f in_plane = (plane_from_object * point.object_mm).cast<float>();
      object.emplace_back(in_plane.x(), in_plane.y(), 0.0F);
      image.emplace_back(static_cast<float>(point.pixel.x()), static_cast<float>(point.pixel.y()));
    }
  }
  cv::Mat intrinsics;
  cv::Mat distortion;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  int flags = cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
  if (!distortion_inside) flags |= cv::CALIB_FIX_K1;
  try {
    cv::calibrateCamera(objects, images, {observations.width, observations.height}, intrinsics,
                        distortion, rotations, translations, flags);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  Zhang found;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      found.intrinsics_px(row, column) = intrinsics.at<double>(row, column);
    }
  }
  if (distortion_inside) found.k1_of_normalised = distortion.at<double>(0);
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    found.eye_from_plane.push_back(pose_of(rotations[i], translations[i]));
    if (!found.eye_from_plane.back().matrix().allFinite()) return std::nullopt;
  }
  if (!found.intrinsics_px.allFinite()) return std::nullopt;
  return found;
}

}  // namespace

std::optional<PerspectiveState> planar_start(const Observations& observations,
                                             bool distortion_inside) {
  const Pose plane_from_object = object_from_plane(observations).inverse();
  const auto found = zhang(observations, plane_from_object, distortion_inside);
  if (!found) return std::nullopt;
  const Eigen::Vector2d focal_mm =
      found->intrinsics_px.diagonal().head<2>().cwiseProduct(observations.pixel_mm);
  PerspectiveState state;
  state.lens.pixel_mm = observations.pixel_mm;
  state.lens.centre_px = found->intrinsics_px.topRightCorner<2, 1>();
  // Near the centre both models agree to first order: x_d = x_u (1 - k1 r_u^2).
  state.lens.k1_per_mm2 = -found->k1_of_normalised / (focal_mm.x() * focal_mm.y());
  const Eigen::Matrix3d intrinsics_mm = focal_mm.homogeneous().asDiagonal();
  for (const Pose& eye_from_plane : found->eye_from_plane) {
    state.matrices.push_back(compose(intrinsics_mm, eye_from_plane * plane_from_object));
  }
  return state;
}

}  // namespace handeye
