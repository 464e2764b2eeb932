// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/two_view.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>

#include "daemon/geometry/median.hpp"

namespace handeye {
namespace {

constexpr int kRotationIterations = 8;
constexpr int kRansacIterations = 400;
constexpr double kConfidence = 0.999;
/// Motions nearer to one another than this (rotation, direction) are one.
constexpr double kSameMotionRad = 0.01;
/// Inliers of a homography from which on the scene may be a plane.
constexpr double kPlaneRatio = 0.6;

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Matrix3d to_eigen(const cv::Mat& matrix) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.ptr<double>());
}

struct RayPoints {
  std::vector<cv::Point2d> first;
  std::vector<cv::Point2d> second;
};

RayPoints to_points(const std::vector<RayPair>& pairs) {
  RayPoints points;
  for (const RayPair& pair : pairs) {
    points.first.emplace_back(pair.first.x(), pair.first.y());
    points.second.emplace_back(pair.second.x(), pair.second.y());
  }
  return points;
}

/// Whether the rays meet in front of both cameras. Near-parallel rays count as in front: their
/// intersection is far away on the side the noise chose.
bool in_front(const Pose& second_from_first, const Eigen::Vector3d& first,
              const Eigen::Vector3d& second) {
  const Eigen::Vector3d turned = second_from_first.linear() * first;
  const Eigen::Vector3d across = turned.cross(second);
  const double squared = across.squaredNorm();
  if (squared < 1e-8) return true;
  // depth_first * turned + t = depth_second * second
  const Eigen::Vector3d& t = second_from_first.translation();
  const double depth_first = second.cross(t).dot(across) / squared;
  const double depth_second = turned.cross(t).dot(across) / squared;
  return depth_first > 0 && depth_second > 0;
}

TwoViewMotion judge(const std::vector<RayPair>& pairs, const Pose& second_from_first,
                    double threshold) {
  TwoViewMotion motion;
  motion.second_from_first = second_from_first;
  std::vector<double> parallaxes;
  for (const RayPair& pair : pairs) {
    if (epipolar_distance(second_from_first, pair) > threshold) continue;
    const Eigen::Vector3d first = pair.first.homogeneous().normalized();
    const Eigen::Vector3d second = pair.second.homogeneous().normalized();
    if (!in_front(second_from_first, first, second)) continue;
    parallaxes.push_back(angle_rad(second_from_first.linear() * first, second));
  }
  motion.inlier_ratio = static_cast<double>(parallaxes.size()) /
                        static_cast<double>(std::max<std::size_t>(1, pairs.size()));
  motion.parallax_rad = median(std::move(parallaxes));
  return motion;
}

void append_essential_motions(const RayPoints& points, double threshold, std::vector<Pose>& poses) {
  cv::Mat mask;
  const cv::Mat essential =
      cv::findEssentialMat(points.first, points.second, cv::Mat::eye(3, 3, CV_64F), cv::RANSAC,
                           kConfidence, threshold, kRansacIterations, mask);
  if (essential.rows != 3 || essential.cols != 3) return;
  cv::Mat rotations[2];
  cv::Mat direction;
  cv::decomposeEssentialMat(essential, rotations[0], rotations[1], direction);
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(direction.ptr<double>()).normalized();
  for (const cv::Mat& rotation : rotations) {
    for (const double sign : {1.0, -1.0}) {
      Pose pose = Pose::Identity();
      pose.linear() = to_eigen(rotation);
      pose.translation() = sign * t;
      poses.push_back(pose);
    }
  }
}

void append_plane_motions(const RayPoints& points, double threshold, std::vector<Pose>& poses) {
  cv::Mat mask;
  const cv::Mat homography =
      cv::findHomography(points.first, points.second, cv::RANSAC, 2.0 * threshold, mask,
                         kRansacIterations, kConfidence);
  if (homography.empty()) return;
  if (cv::countNonZero(mask) < kPlaneRatio * static_cast<double>(points.first.size())) return;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  std::vector<cv::Mat> normals;
  cv::decomposeHomographyMat(homography, cv::Mat::eye(3, 3, CV_64F), rotations, translations,
                             normals);
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3d>(translations[i].ptr<double>());
    if (!(t.norm() > 1e-9)) continue;
    Pose pose = Pose::Identity();
    pose.linear() = to_eigen(rotations[i]);
    pose.translation() = t.normalized();
    poses.push_back(pose);
  }
}

bool same_motion(const Pose& a, const Pose& b) {
  return rotation_angle_rad(a.linear(), b.linear()) < kSameMotionRad &&
         angle_rad(a.translation(), b.translation()) < 5.0 * kSameMotionRad;
}

}  // namespace

double epipolar_distance(const Pose& second_from_first, const RayPair& pair) {
  const Eigen::Matrix3d essential =
      skew(second_from_first.translation()) * second_from_first.linear();
  const Eigen::Vector3d first = pair.first.homogeneous();
  const Eigen::Vector3d second = pair.second.homogeneous();
  const Eigen::Vector3d line_second = essential * first;
  const Eigen::Vector3d line_first = essential.transpose() * second;
  const double scale = line_second.head<2>().squaredNorm() + line_first.head<2>().squaredNorm();
  return std::abs(second.dot(line_second)) / std::sqrt(std::max(scale, 1e-18));
}

double median_movement(const std::vector<RayPair>& pairs) {
  std::vector<double> movements;
  movements.reserve(pairs.size());
  for (const RayPair& pair : pairs) movements.push_back((pair.second - pair.first).norm());
  return median(std::move(movements));
}

RotationFit fit_rotation(const std::vector<RayPair>& pairs, double threshold_rad) {
  RotationFit fit;
  if (pairs.empty()) return fit;
  std::vector<double> errors(pairs.size(), 0.0);
  std::vector<double> weights(pairs.size(), 1.0);
  for (int iteration = 0; iteration < kRotationIterations; ++iteration) {
    Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      correlation += weights[i] * pairs[i].second.homogeneous().normalized() *
                     pairs[i].first.homogeneous().normalized().transpose();
    }
    fit.second_from_first = nearest_rotation(correlation);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      errors[i] = angle_rad(fit.second_from_first * pairs[i].first.homogeneous().normalized(),
                            pairs[i].second.homogeneous().normalized());
    }
    const double width = std::max(threshold_rad, 1.5 * median(errors));
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      weights[i] = 1.0 / (1.0 + errors[i] * errors[i] / (width * width));
    }
  }
  const auto inliers = std::count_if(errors.begin(), errors.end(),
                                     [&](double error) { return error <= threshold_rad; });
  fit.inlier_ratio = static_cast<double>(inliers) / static_cast<double>(pairs.size());
  fit.residual_rad = median(std::move(errors));
  return fit;
}

std::vector<TwoViewMotion> two_view_motions(const std::vector<RayPair>& pairs,
                                            double threshold_rad) {
  std::vector<TwoViewMotion> motions;
  if (pairs.size() < 8) return motions;
  const RayPoints points = to_points(pairs);
  std::vector<Pose> poses;
  append_essential_motions(points, threshold_rad, poses);
  append_plane_motions(points, threshold_rad, poses);
  for (const Pose& pose : poses) {
    const bool known = std::any_of(motions.begin(), motions.end(), [&](const auto& motion) {
      return same_motion(motion.second_from_first, pose);
    });
    if (!known) motions.push_back(judge(pairs, pose, threshold_rad));
  }
  std::stable_sort(motions.begin(), motions.end(),
                   [](const auto& a, const auto& b) { return a.inlier_ratio > b.inlier_ratio; });
  return motions;
}

}  // namespace handeye
