// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/adjustment/reprojection_cost.hpp"

#include <cmath>

#include "daemon/adjustment/pose_manifold.hpp"
#include "daemon/geometry/projection.hpp"

namespace handeye {
namespace {

/// Pose and point as Ceres hands them over, brought into the eye's frame.
struct SeenPoint {
  explicit SeenPoint(const double* const* parameters)
      : rotation(Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(parameters[0]))
                     .toRotationMatrix()),
        rotated(rotation * Eigen::Map<const Eigen::Vector3d>(parameters[1])),
        eye(rotated + Eigen::Map<const Eigen::Vector3d>(parameters[0] + 4)) {}

  Eigen::Matrix3d rotation;
  Eigen::Vector3d rotated;
  Eigen::Vector3d eye;
};

void write_derivatives(const SeenPoint& point, const Projection& projection, double** jacobians) {
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> by_pose(jacobians[0]);
    by_pose.leftCols<3>() = -projection.by_point_eye * skew(point.rotated);
    by_pose.middleCols<3>(3) = projection.by_point_eye;
    by_pose.col(6).setZero();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>{jacobians[1]} =
        projection.by_point_eye * point.rotation;
  }
}

}  // namespace

bool ReprojectionCost::Evaluate(const double* const* parameters, double* residuals,
                                double** jacobians) const {
  const SeenPoint point(parameters);
  // A step that takes a point behind a camera is refused: Ceres then tries a shorter one.
  if (!(point.eye.z() > 0)) return false;
  const Projection projection = project_with_derivative(camera_, point.eye);
  Eigen::Map<Eigen::Vector2d>{residuals} = projection.pixel - pixel_;
  if (jacobians != nullptr) write_derivatives(point, projection, jacobians);
  return true;
}

bool LensReprojectionCost::Evaluate(const double* const* parameters, double* residuals,
                                    double** jacobians) const {
  const SeenPoint point(parameters);
  const Eigen::Map<const LensVector> lens(parameters[2]);
  if (!(point.eye.z() > 0) || !(lens[kFocal] > 0)) return false;
  const CameraModel camera = with_lens(camera_, lens);
  const Projection projection = project_with_derivative(camera, point.eye);
  Eigen::Map<Eigen::Vector2d>{residuals} = projection.pixel - pixel_;
  if (jacobians == nullptr) return true;
  write_derivatives(point, projection, jacobians);
  if (jacobians[2] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, kLensParameters, Eigen::RowMajor>>{jacobians[2]} =
        pixel_by_lens(camera, point.eye);
  }
  return true;
}

}  // namespace handeye
