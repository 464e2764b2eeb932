// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/corner_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

constexpr int kSmallestWindow_px = 2;
constexpr int kLargestWindow_px = 11;
constexpr double kDarkestMean = 8;
constexpr double kEvenLevel = 110;     // leaves room up to 2.3 times the mean
constexpr double kFarthestMove = 0.3;  // of the spacing
constexpr int kIterations = 40;
constexpr double kSettled_px = 0.001;

}  // namespace

const cv::Mat& SearchImage::shrink(const cv::Mat& grey, int max_width) {
  scale_x_ = scale_y_ = 1;
  current_ = grey;
  if (grey.cols <= max_width) return current_;
  const int height = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(grey.rows) * max_width / grey.cols)));
  cv::resize(grey, shrunk_, cv::Size(max_width, height), 0, 0, cv::INTER_AREA);
  scale_x_ = static_cast<double>(grey.cols) / shrunk_.cols;
  scale_y_ = static_cast<double>(grey.rows) / shrunk_.rows;
  current_ = shrunk_;
  return current_;
}

const cv::Mat& SearchImage::even_out(int side_px) {
  cv::boxFilter(current_, mean_, -1, cv::Size(side_px, side_px), cv::Point(-1, -1), true,
                cv::BORDER_REPLICATE);
  // Outside a round field of view there is nothing but grain to bring out.
  cv::max(mean_, kDarkestMean, mean_);
  cv::divide(current_, mean_, even_, kEvenLevel);
  return even_;
}

cv::Point2f SearchImage::to_full_size(const cv::Point2f& pixel) const {
  // Pixel centres are at integers: the images' edges, not their first centres, coincide.
  return {static_cast<float>((pixel.x + 0.5) * scale_x_ - 0.5),
          static_cast<float>((pixel.y + 0.5) * scale_y_ - 0.5)};
}

double corner_spacing_px(const Board& board, std::span<const int> ids,
                         std::span<const cv::Point2f> pixels) {
  double shortest = std::numeric_limits<double>::infinity();
  const int columns = board.corner_columns();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool last_of_row = ids[i] % columns == columns - 1;
    for (const int neighbour : {ids[i] + 1, ids[i] + columns}) {
      if (neighbour == ids[i] + 1 && last_of_row) continue;
      const auto found = std::ranges::lower_bound(ids, neighbour);
      if (found == ids.end() || *found != neighbour) continue;
      const cv::Point2f step = pixels[static_cast<std::size_t>(found - ids.begin())] - pixels[i];
      shortest = std::min(shortest, cv::norm(step));
    }
  }
  return std::isfinite(shortest) ? shortest : 0;
}

std::vector<bool> refine_corners(const cv::Mat& grey, double window_px, double spacing_px,
                                 std::vector<cv::Point2f>& pixels) {
  const std::vector<cv::Point2f> start = pixels;
  const int window =
      std::clamp(static_cast<int>(std::floor(window_px)), kSmallestWindow_px, kLargestWindow_px);
  cv::cornerSubPix(
      grey, pixels, cv::Size(window, window), cv::Size(-1, -1),
      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations, kSettled_px));
  std::vector<bool> stayed(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const cv::Point2f move = pixels[i] - start[i];
    stayed[i] = cv::norm(move) < kFarthestMove * spacing_px;
  }
  return stayed;
}

}  // namespace handeye
