// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/board_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <opencv2/calib3d.hpp>

#include "daemon/pattern/opencv_camera.hpp"

namespace handeye {
namespace {

constexpr std::size_t kFewestCorners = 4;
// Spread across the longest line through the corners, of that along it.
constexpr double kThinnest = 0.05;
// Two refined poses this near are one.
constexpr double kSamePose_rad = 1e-3;
// The corners' noise is estimated from the fit, which is exact for synthetic ones [px].
constexpr double kLeastNoise_px = 0.02;

struct Fit {
  Pose eye_from_board{Pose::Identity()};
  double squares_px2{std::numeric_limits<double>::infinity()};  ///< infinite: not possible
};

bool on_one_line(const std::vector<Eigen::Vector3d>& corners_mm,
                 const std::vector<BoardCorner>& corners) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  const auto count = static_cast<double>(corners.size());
  for (const BoardCorner& corner : corners) {
    mean += corners_mm[static_cast<std::size_t>(corner.id)].head<2>() / count;
  }
  for (const BoardCorner& corner : corners) {
    const Eigen::Vector2d offset = corners_mm[static_cast<std::size_t>(corner.id)].head<2>() - mean;
    moment += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moment, Eigen::EigenvaluesOnly);
  return axes.eigenvalues()(0) < kThinnest * kThinnest * axes.eigenvalues()(1);
}

Pose pose_from_opencv(const cv::Vec3d& rotation, const cv::Vec3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3({rotation[0], rotation[1], rotation[2]});
  pose.translation() = Eigen::Vector3d(translation[0], translation[1], translation[2]);
  return pose;
}

double squares_px2(const Pose& eye_from_board, const std::vector<Eigen::Vector3d>& corners_mm,
                   const std::vector<BoardCorner>& corners, const CameraModel& camera) {
  double sum = 0;
  for (const BoardCorner& corner : corners) {
    const Eigen::Vector3d point_eye =
        eye_from_board * corners_mm[static_cast<std::size_t>(corner.id)];
    if (point_eye.z() <= 0) return std::numeric_limits<double>::infinity();
    sum += (project<double>(camera, point_eye) - corner.pixel).squaredNorm();
  }
  return sum;
}

/// Both planar solutions, refined, the better one first. Throws cv::Exception for corners that
/// OpenCV makes nothing of.
std::vector<Fit> fits(const std::vector<Eigen::Vector3d>& corners_mm,
                      const std::vector<BoardCorner>& corners, const CameraModel& camera) {
  const CornerPairs pairs = pair_corners(corners_mm, corners);
  const cv::Matx33d matrix = camera_matrix(camera);
  const cv::Mat distortion = distortion_coefficients(camera);
  std::vector<cv::Vec3d> rotations;
  std::vector<cv::Vec3d> translations;
  cv::solvePnPGeneric(pairs.board_mm, pairs.pixels, matrix, distortion, rotations, translations,
                      false, cv::SOLVEPNP_IPPE);
  std::vector<Fit> found;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    cv::solvePnPRefineLM(
        pairs.board_mm, pairs.pixels, matrix, distortion, rotations[i], translations[i],
        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-12));
    const Pose pose = pose_from_opencv(rotations[i], translations[i]);
    const double squares = squares_px2(pose, corners_mm, corners, camera);
    if (std::isfinite(squares)) found.push_back({pose, squares});
  }
  std::ranges::sort(found, {}, &Fit::squares_px2);
  return found;
}

std::vector<Fit> fits_or_none(const std::vector<Eigen::Vector3d>& corners_mm,
                              const std::vector<BoardCorner>& corners, const CameraModel& camera) {
  try {
    return fits(corners_mm, corners, camera);
  } catch (const cv::Exception&) {
    return {};
  }
}

bool is_same(const Fit& a, const Fit& b) {
  return rotation_angle_rad(a.eye_from_board.linear(), b.eye_from_board.linear()) < kSamePose_rad;
}

}  // namespace

std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector3d>& corners_mm,
                                    const std::vector<BoardCorner>& corners,
                                    const CameraModel& camera, const BoardPoseOptions& options) {
  if (corners.size() < kFewestCorners || on_one_line(corners_mm, corners)) return std::nullopt;
  const std::vector<Fit> found = fits_or_none(corners_mm, corners, camera);
  if (found.empty()) return std::nullopt;
  const Fit& best = found.front();
  const auto count = static_cast<double>(corners.size());
  const double rms_px = std::sqrt(best.squares_px2 / count);
  if (!(rms_px <= options.max_reprojection_px)) return std::nullopt;

  const double degrees_of_freedom = 2 * count - 6;
  const double variance_px2 =
      std::max(best.squares_px2 / degrees_of_freedom, kLeastNoise_px * kLeastNoise_px);
  const bool mirrored =
      found.size() > 1 && !is_same(best, found[1]) &&
      found[1].squares_px2 - best.squares_px2 < options.min_mirror_chi2 * variance_px2;
  if (mirrored) return std::nullopt;
  return BoardPose{best.eye_from_board, rms_px};
}

}  // namespace handeye
