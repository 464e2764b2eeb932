// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/resection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

#include "daemon/geometry/median.hpp"
#include "daemon/geometry/projection.hpp"

namespace handeye {
namespace {

constexpr int kRobustIterations = 12;
constexpr int kPolishIterations = 5;
constexpr double kMinDepth = 1e-6;
constexpr int kRansacIterations = 300;
/// Where there are enough matches of this weight, RANSAC draws from them alone.
constexpr double kTrustedWeight = 0.25;
/// What a match is taken to be worth when a pose's uncertainty is judged: not the noise alone, but
/// what tracks and points are off by in the long run.
constexpr double kMatchSigmaPx = 0.7;
constexpr double kMaxSigmaRad = 0.01;
constexpr double kMaxSigmaOfDepth = 0.01;

double error_px(const CameraModel& camera, const Pose& eye_from_scene, const PointMatch& match) {
  const Eigen::Vector3d point_eye = eye_from_scene * match.point_scene;
  if (!(point_eye.z() > kMinDepth)) return std::numeric_limits<double>::infinity();
  return (project<double>(camera, point_eye) - match.pixel).norm();
}

/// One weighted Gauss-Newton step: left perturbation of the rotation, translation added.
/// `weight` maps an error in px to a weight. Returns the step's size in rad and relative depth.
template <typename Weight>
double step_pose(const CameraModel& camera, const std::vector<PointMatch>& matches,
                 const Weight& weight, Pose& pose) {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double depth = kMinDepth;
  for (const PointMatch& match : matches) {
    const Eigen::Vector3d rotated = pose.linear() * match.point_scene;
    const Eigen::Vector3d point_eye = rotated + pose.translation();
    if (!(point_eye.z() > kMinDepth)) continue;
    const Projection projection = project_with_derivative(camera, point_eye);
    const Eigen::Vector2d error = projection.pixel - match.pixel;
    const double w = match.weight * weight(error.norm());
    if (w <= 0) continue;
    Eigen::Matrix<double, 2, 6> by_pose;
    by_pose.leftCols<3>() = -projection.by_point_eye * skew(rotated);
    by_pose.rightCols<3>() = projection.by_point_eye;
    normal.noalias() += w * by_pose.transpose() * by_pose;
    gradient.noalias() += w * by_pose.transpose() * error;
    depth = std::max(depth, point_eye.z());
  }
  const Vector6d step = normal.ldlt().solve(gradient);
  if (!step.allFinite()) return std::numeric_limits<double>::infinity();
  pose.linear() = exp_so3(-step.head<3>()) * pose.linear();
  pose.translation() -= step.tail<3>();
  return step.head<3>().norm() + step.tail<3>().norm() / depth;
}

std::optional<Pose> pose_by_ransac(const CameraModel& camera,
                                   const std::vector<PointMatch>& matches,
                                   const ResectionOptions& options) {
  const auto enough = std::max<std::ptrdiff_t>(4, options.min_inliers);
  const auto trusted = std::count_if(matches.begin(), matches.end(), [](const PointMatch& match) {
    return match.weight >= kTrustedWeight;
  });
  const double least_weight = trusted >= enough ? kTrustedWeight : 0.0;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> rays;
  for (const PointMatch& match : matches) {
    if (match.weight < least_weight) continue;
    const auto ray = unproject(camera, match.pixel);
    if (!ray) continue;
    points.emplace_back(match.point_scene.x(), match.point_scene.y(), match.point_scene.z());
    rays.emplace_back(ray->x(), ray->y());
  }
  if (static_cast<std::ptrdiff_t>(points.size()) < enough) return std::nullopt;
  // OpenCV seeds this RANSAC with a constant: the same matches give the same pose.
  cv::Vec3d rotation;
  cv::Vec3d translation;
  std::vector<int> inliers;
  const auto threshold = static_cast<float>(2.0 * options.max_reprojection_px / focal_px(camera));
  if (!cv::solvePnPRansac(points, rays, cv::Matx33d::eye(), cv::noArray(), rotation, translation,
                          false, kRansacIterations, threshold, 0.999, inliers, cv::SOLVEPNP_AP3P)) {
    return std::nullopt;
  }
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3({rotation[0], rotation[1], rotation[2]});
  pose.translation() = Eigen::Vector3d(translation[0], translation[1], translation[2]);
  if (!pose.matrix().allFinite()) return std::nullopt;
  return pose;
}

/// What is known of a pose by its inliers, at an image noise of 1 px: of (w [rad], v) about the
/// eye's own axes, p <- Exp(w) p + v of a point in the eye, where both are least entangled.
struct PoseSpread {
  Matrix6d covariance_about_eye;
  double median_depth{0};
};

/// Nothing where the inliers leave the pose free to move.
std::optional<PoseSpread> pose_spread(const CameraModel& camera,
                                      const std::vector<PointMatch>& matches, double max_error_px,
                                      const Pose& pose) {
  Matrix6d normal = Matrix6d::Zero();
  std::vector<double> depths;
  for (const PointMatch& match : matches) {
    if (error_px(camera, pose, match) > max_error_px) continue;
    const Eigen::Vector3d point_eye = pose * match.point_scene;
    const Projection projection = project_with_derivative(camera, point_eye);
    Eigen::Matrix<double, 2, 6> by_pose;
    by_pose.leftCols<3>() = -projection.by_point_eye * skew(point_eye);
    by_pose.rightCols<3>() = projection.by_point_eye;
    normal.noalias() += match.weight * by_pose.transpose() * by_pose;
    depths.push_back(point_eye.z());
  }
  const Eigen::LDLT<Matrix6d> factorised(normal);
  if (factorised.info() != Eigen::Success || !factorised.isPositive()) return std::nullopt;
  return PoseSpread{factorised.solve(Matrix6d::Identity()), median(std::move(depths))};
}

/// Whether the inliers hold the pose in place: with few, or all in one corner of the image, a pose
/// may fit them well and yet be far off.
bool is_well_determined(const PoseSpread& spread) {
  const Matrix6d& unit = spread.covariance_about_eye;
  const double rotation_rad = kMatchSigmaPx * std::sqrt(unit.topLeftCorner<3, 3>().trace());
  const double shift = kMatchSigmaPx * std::sqrt(unit.bottomRightCorner<3, 3>().trace());
  // Comparisons that a NaN fails.
  return rotation_rad <= kMaxSigmaRad && shift <= kMaxSigmaOfDepth * spread.median_depth;
}

/// From steps about the eye's axes to those of R = Exp(w) R, t = t + dt: Exp(w) (R p + t) + v moves
/// t by w x t + v.
Matrix6d by_pose_steps(const Matrix6d& covariance_about_eye, const Eigen::Vector3d& translation) {
  Matrix6d steps = Matrix6d::Identity();
  steps.bottomLeftCorner<3, 3>() = -skew(translation);
  return steps * covariance_about_eye * steps.transpose();
}

}  // namespace

std::optional<Resection> refine_pose(const CameraModel& camera,
                                     const std::vector<PointMatch>& matches, const Pose& predicted,
                                     const ResectionOptions& options) {
  if (static_cast<int>(matches.size()) < options.min_inliers) return std::nullopt;
  Resection result;
  Pose& pose = result.eye_from_scene;
  pose = predicted;
  std::vector<double> errors_px(matches.size());
  // Cauchy weights whose width follows the errors: from a poor prediction it begins wide.
  for (int iteration = 0; iteration < kRobustIterations; ++iteration) {
    for (std::size_t i = 0; i < matches.size(); ++i) {
      errors_px[i] = error_px(camera, pose, matches[i]);
    }
    const double width_px = std::max(options.robust_px, 1.5 * median(errors_px));
    if (!std::isfinite(width_px)) return std::nullopt;
    const double step = step_pose(
        camera, matches,
        [width_px](double error) { return 1.0 / (1.0 + error * error / (width_px * width_px)); },
        pose);
    if (!std::isfinite(step)) return std::nullopt;
    if (step < 1e-6) break;
  }
  // Huber on the inliers alone, as the adjustment of the whole scene will judge them.
  for (int iteration = 0; iteration < kPolishIterations; ++iteration) {
    const double step = step_pose(
        camera, matches,
        [&options](double error) {
          if (error > options.max_reprojection_px) return 0.0;
          return error <= options.robust_px ? 1.0 : options.robust_px / error;
        },
        pose);
    if (!std::isfinite(step)) return std::nullopt;
    if (step < 1e-9) break;
  }
  double sum = 0.0;
  double weight_of_all = 0.0;
  double weight_of_inliers = 0.0;
  for (const PointMatch& match : matches) {
    const double error = error_px(camera, pose, match);
    weight_of_all += match.weight;
    if (error > options.max_reprojection_px) continue;
    sum += error * error;
    weight_of_inliers += match.weight;
    ++result.inliers;
  }
  if (result.inliers < options.min_inliers ||
      weight_of_inliers < options.min_inlier_ratio * weight_of_all) {
    return std::nullopt;
  }
  result.reprojection_px = std::sqrt(sum / result.inliers);
  // Predicted from frames that were predicted themselves: rounding would pile up.
  pose.linear() = nearest_rotation(pose.linear());
  const auto spread = pose_spread(camera, matches, options.max_reprojection_px, pose);
  if (!spread || !is_well_determined(*spread)) return std::nullopt;
  result.unit_covariance = by_pose_steps(spread->covariance_about_eye, pose.translation());
  return result;
}

std::optional<Resection> resect(const CameraModel& camera, const std::vector<PointMatch>& matches,
                                const Pose& predicted, const ResectionOptions& options) {
  if (auto near = refine_pose(camera, matches, predicted, options)) return near;
  const auto found = pose_by_ransac(camera, matches, options);
  if (!found) return std::nullopt;
  return refine_pose(camera, matches, *found, options);
}

}  // namespace handeye
