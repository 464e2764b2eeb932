// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/intrinsics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/calib3d.hpp>

#include "daemon/geometry/pose.hpp"
#include "daemon/pattern/opencv_camera.hpp"

namespace handeye {
namespace {

/// What OpenCV calibrates from, and what it finds.
struct Problem {
  std::vector<std::vector<cv::Point3f>> board_mm;
  std::vector<std::vector<cv::Point2f>> pixels;
  cv::Size size;
};
struct Solution {
  cv::Mat matrix, distortion, sigma, view_px;
  std::vector<cv::Mat> rotations, translations;
  double rms_px{0};

  double value(int index) const { return distortion.at<double>(index); }
  bool finite() const {
    return std::isfinite(rms_px) && cv::checkRange(matrix) && cv::checkRange(distortion);
  }
};

Problem problem_of(const Board& board, const std::vector<std::vector<BoardCorner>>& views,
                   cv::Size size) {
  const std::vector<Eigen::Vector3d> corners_mm = board.corners_mm();
  Problem problem{.size = size};
  for (const std::vector<BoardCorner>& view : views) {
    CornerPairs pairs = pair_corners(corners_mm, view);
    problem.board_mm.push_back(std::move(pairs.board_mm));
    problem.pixels.push_back(std::move(pairs.pixels));
  }
  return problem;
}

/// OpenCV 4.6 divides the sum of squares by the number of corners minus that of unknowns; each
/// corner gives two figures.
double sigma_correction(const Problem& problem, int intrinsic_unknowns) {
  double corners = 0;
  for (const auto& view : problem.pixels) corners += static_cast<double>(view.size());
  const double unknowns = intrinsic_unknowns + 6.0 * static_cast<double>(problem.pixels.size());
  return std::sqrt((corners - unknowns) / (2 * corners - unknowns));
}

/// Nothing where OpenCV gives up: it throws for views that determine nothing.
std::optional<Solution> solve(const Problem& problem, const cv::Mat& start, int flags) {
  Solution solution;
  cv::Mat sigma_poses;
  solution.matrix = start.clone();
  if (!start.empty()) flags |= cv::CALIB_USE_INTRINSIC_GUESS;
  try {
    solution.rms_px = cv::calibrateCamera(
        problem.board_mm, problem.pixels, problem.size, solution.matrix, solution.distortion,
        solution.rotations, solution.translations, solution.sigma, sigma_poses, solution.view_px,
        flags, cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-12));
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  if (!solution.finite()) return std::nullopt;
  const int unknowns = (flags & cv::CALIB_FIX_K3) != 0 ? 8 : 9;
  solution.sigma *= sigma_correction(problem, unknowns);
  return solution;
}

/// A camera that is never far off, for views from which the closed form cannot tell one.
cv::Mat ordinary_camera(cv::Size size) {
  const double focal_px = std::max(size.width, size.height);
  return (cv::Mat_<double>(3, 3) << focal_px, 0, 0.5 * (size.width - 1), 0, focal_px,
          0.5 * (size.height - 1), 0, 0, 1);
}

/// With k3 where the views show one, else without.
std::optional<Solution> best_solution(const Problem& problem, const IntrinsicsOptions& options) {
  std::optional<Solution> four = solve(problem, {}, cv::CALIB_FIX_K3);
  if (!four) four = solve(problem, ordinary_camera(problem.size), cv::CALIB_FIX_K3);
  if (!four) return std::nullopt;
  const std::optional<Solution> five = solve(problem, four->matrix, 0);
  const double kept = 1 - options.min_k3_gain;
  const bool shown = five && five->rms_px * five->rms_px < kept * four->rms_px * four->rms_px;
  return shown ? five : four;
}

void write_camera(const Solution& solution, cv::Size size, Intrinsics& result) {
  CameraModel& camera = result.camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = solution.matrix.at<double>(0, 0);
  camera.fy = solution.matrix.at<double>(1, 1);
  camera.cx = solution.matrix.at<double>(0, 2);
  camera.cy = solution.matrix.at<double>(1, 2);
  result.sigma = {solution.sigma.at<double>(0),
                  solution.sigma.at<double>(1),
                  solution.sigma.at<double>(2),
                  solution.sigma.at<double>(3),
                  {}};
  for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
    camera.distortion[i] = solution.value(static_cast<int>(i));
    result.sigma.distortion[i] = solution.sigma.at<double>(static_cast<int>(4 + i));
  }
  result.reprojection_px = solution.rms_px;
  result.view_reprojection_px.assign(solution.view_px.begin<double>(),
                                     solution.view_px.end<double>());
}

/// Largest angle between the boards' normals, seen through an ordinary camera: what is parallel is
/// so through any, and the one found may be anything.
double attitude_spread_deg(const Problem& problem) {
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t view = 0; view < problem.pixels.size(); ++view) {
    cv::Vec3d rotation;
    cv::Vec3d translation;
    cv::solvePnP(problem.board_mm[view], problem.pixels[view], ordinary_camera(problem.size),
                 cv::noArray(), rotation, translation);
    normals.push_back(exp_so3({rotation[0], rotation[1], rotation[2]}).col(2));
  }
  double largest_rad = 0;
  for (const Eigen::Vector3d& a : normals) {
    for (const Eigen::Vector3d& b : normals) {
      largest_rad = std::max(largest_rad, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return deg_from_rad(largest_rad);
}

bool is_certain(const Intrinsics& result, const IntrinsicsOptions& options) {
  const CameraModel& camera = result.camera;
  const IntrinsicsSigma& sigma = result.sigma;
  const double center_px = options.max_center_sigma * std::max(camera.width, camera.height);
  // Written so that what is no number is not certain.
  return sigma.fx <= options.max_focal_sigma * camera.fx &&
         sigma.fy <= options.max_focal_sigma * camera.fy && sigma.cx <= center_px &&
         sigma.cy <= center_px;
}

bool is_plausible(const Intrinsics& result, const IntrinsicsOptions& options) {
  const CameraModel& camera = result.camera;
  return !camera.problem() && camera.cx > 0 && camera.cx < camera.width && camera.cy > 0 &&
         camera.cy < camera.height && result.reprojection_px <= options.max_reprojection_px;
}

}  // namespace

std::string_view intrinsics_word(IntrinsicsProblem problem) {
  switch (problem) {
    case IntrinsicsProblem::kNone:
      return "";
    case IntrinsicsProblem::kParallelViews:
      return "parallel_views";
    case IntrinsicsProblem::kUncertain:
      return "uncertain";
    case IntrinsicsProblem::kImplausible:
      break;
  }
  return "implausible";
}

std::string_view intrinsics_advice(IntrinsicsProblem problem) {
  switch (problem) {
    case IntrinsicsProblem::kNone:
      return "";
    case IntrinsicsProblem::kParallelViews:
      return "The board was tilted the same way in every image: tilt it by 20 to 40 degrees, "
             "another way in each.";
    case IntrinsicsProblem::kUncertain:
      return "The camera is not certain enough: take more images, with the board tilted by 20 to "
             "40 degrees in different ways and all over the view.";
    case IntrinsicsProblem::kImplausible:
      break;
  }
  return "The camera does not fit the images: check the board's counts, that it is flat, and that "
         "all images are of one camera and one zoom.";
}

Intrinsics calibrate_intrinsics(const Board& board,
                                const std::vector<std::vector<BoardCorner>>& views, cv::Size size,
                                const IntrinsicsOptions& options) {
  Intrinsics result;
  result.camera.width = size.width;
  result.camera.height = size.height;
  const Problem problem = problem_of(board, views, size);
  const auto solution = best_solution(problem, options);
  if (!solution) {
    result.problem = IntrinsicsProblem::kParallelViews;
    return result;
  }
  write_camera(*solution, size, result);
  if (!is_certain(result, options)) {
    result.problem = attitude_spread_deg(problem) < options.min_attitude_spread_deg
                         ? IntrinsicsProblem::kParallelViews
                         : IntrinsicsProblem::kUncertain;
  } else if (!is_plausible(result, options)) {
    result.problem = IntrinsicsProblem::kImplausible;
  }
  return result;
}

}  // namespace handeye
