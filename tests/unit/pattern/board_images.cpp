// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/pattern/board_images.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

namespace handeye::test {
namespace {

constexpr int kSide = 3;            // rays along a pixel's side
constexpr int kSquare_px = 60;      // of the print
constexpr double kOptics_px = 0.7;  // blur
constexpr float kNoise_levels = 1;
constexpr std::uint8_t kDark = 40;
constexpr std::uint8_t kLight = 190;
constexpr std::uint8_t kAround = 110;

/// Squares of the whole board, the outermost ones included.
cv::Size squares(const Board& board) {
  return {board.corner_columns() + 1, board.corner_rows() + 1};
}

cv::Mat chessboard_print(const Board& board) {
  const cv::Size count = squares(board);
  cv::Mat print(count * kSquare_px, CV_8UC1);
  for (int row = 0; row < print.rows; ++row) {
    for (int column = 0; column < print.cols; ++column) {
      const bool dark = (row / kSquare_px + column / kSquare_px) % 2 == 0;
      print.at<std::uint8_t>(row, column) = dark ? 0 : 255;
    }
  }
  return print;
}

cv::Mat charuco_print(const Board& board) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  const auto charuco = cv::aruco::CharucoBoard::create(
      board.columns, board.rows, static_cast<float>(board.square_mm),
      static_cast<float>(board.marker_mm), dictionary);
  cv::Mat print;
  charuco->draw(squares(board) * kSquare_px, print, 0);
  return print;
}

}  // namespace

BoardImages::BoardImages(const Board& board, const CameraModel& camera)
    : board_(board),
      camera_(camera),
      print_(board.kind == Board::Kind::kChessboard ? chessboard_print(board)
                                                    : charuco_print(board)) {
  for (int row = 0; row <= camera.height; ++row) {
    for (int column = 0; column <= camera.width; ++column) {
      const auto ray = unproject(camera, Eigen::Vector2d(column - 0.5, row - 0.5));
      rays_.push_back(ray.value_or(Eigen::Vector2d(1e3, 1e3)));
    }
  }
}

/// Through a point of a pixel, given as fractions of its sides.
Eigen::Vector2d BoardImages::ray(int column, int row, double x, double y) const {
  const std::size_t top =
      static_cast<std::size_t>(row) * (camera_.width + 1U) + static_cast<std::size_t>(column);
  const std::size_t bottom = top + camera_.width + 1U;
  return (1 - y) * ((1 - x) * rays_[top] + x * rays_[top + 1]) +
         y * ((1 - x) * rays_[bottom] + x * rays_[bottom + 1]);
}

std::uint8_t BoardImages::grey_at(const Eigen::Vector2d& board_mm) const {
  // The board's origin is its first inner corner, one square inside the print.
  const Eigen::Vector2d print_px =
      kSquare_px * (board_mm / board_.square_mm + Eigen::Vector2d::Ones());
  const auto column = static_cast<int>(std::floor(print_px.x()));
  const auto row = static_cast<int>(std::floor(print_px.y()));
  if (cv::Rect(cv::Point(), print_.size()).contains({column, row})) {
    return print_.at<std::uint8_t>(row, column) == 0 ? kDark : kLight;
  }
  const bool margin = column >= -kSquare_px && row >= -kSquare_px &&
                      column < print_.cols + kSquare_px && row < print_.rows + kSquare_px;
  return margin ? kLight : kAround;
}

cv::Mat BoardImages::image(const Pose& eye_from_board) {
  const Pose board_from_eye = eye_from_board.inverse();
  const Eigen::Vector3d eye_mm = board_from_eye.translation();
  cv::Mat level(camera_.height, camera_.width, CV_32FC1);
  // Rays at random places of a grid's cells: on the grid itself, edges would move in steps.
  std::uniform_real_distribution<double> within_cell(0, 1.0 / kSide);
  for (int row = 0; row < level.rows; ++row) {
    for (int column = 0; column < level.cols; ++column) {
      double sum = 0;
      for (int cell = 0; cell < kSide * kSide; ++cell) {
        const double x = static_cast<double>(cell % kSide) / kSide + within_cell(random_);
        const double y = static_cast<double>(cell / kSide) / kSide + within_cell(random_);
        const Eigen::Vector3d direction =
            board_from_eye.linear() * ray(column, row, x, y).homogeneous();
        const double depth = -eye_mm.z() / direction.z();
        sum += depth > 0 ? grey_at((eye_mm + depth * direction).head<2>()) : kAround;
      }
      level.at<float>(row, column) = static_cast<float>(sum / (kSide * kSide));
    }
  }
  cv::GaussianBlur(level, level, cv::Size(), kOptics_px);
  std::normal_distribution<float> noise(0, kNoise_levels);
  std::for_each(level.begin<float>(), level.end<float>(),
                [&](float& pixel) { pixel += noise(random_); });
  cv::Mat grey;
  level.convertTo(grey, CV_8U);
  return grey;
}

std::vector<Eigen::Vector2d> BoardImages::true_pixels(const Pose& eye_from_board) const {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& corner : board_.corners_mm()) {
    pixels.push_back(project<double>(camera_, Eigen::Vector3d(eye_from_board * corner)));
  }
  return pixels;
}

Pose board_in_view(const Board& board, double distance_mm, const Eigen::Vector3d& tilt,
                   const Eigen::Vector2d& shift_mm) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(tilt);
  const Eigen::Vector3d middle_mm(0.5 * (board.corner_columns() - 1) * board.square_mm,
                                  0.5 * (board.corner_rows() - 1) * board.square_mm, 0);
  pose.translation() =
      Eigen::Vector3d(shift_mm.x(), shift_mm.y(), distance_mm) - pose.linear() * middle_mm;
  return pose;
}

}  // namespace handeye::test
