// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/field_of_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

constexpr int kWorkingWidth = 320;  ///< px; the disc is large, details only disturb
constexpr double kBrightQuantile = 0.95;
constexpr int kTooDark = 40;  ///< grey; an image whose bright parts are darker tells nothing
constexpr double kDarkFraction =
    0.1;                        ///< surroundings are darker than this share of the bright parts
constexpr int kDarkFloor = 10;  ///< grey; black level and noise of real cameras
constexpr int kCornerFraction = 12;      ///< corners looked at: this fraction of the width
constexpr double kCornerDark = 0.9;      ///< share of a corner that must be dark
constexpr double kCloseFraction = 0.06;  ///< of the width: shadows at the rim this wide are bridged
/// Of the disc's radius: the rim's glow grows with the disc.
constexpr double kErodeFraction = 0.05;
constexpr double kMinArea = 0.08;  ///< of the image
constexpr double kMinRoundness =
    0.6;  ///< area over that of the enclosing circle (a disc cut by the frame)
constexpr double kMinSolidity = 0.88;  ///< area over that of the convex hull

int grey_quantile(const cv::Mat& grey, double fraction) {
  std::array<int, 256> histogram{};
  for (int y = 0; y < grey.rows; ++y) {
    const auto* row = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x < grey.cols; ++x) ++histogram[row[x]];
  }
  const auto wanted = static_cast<int>(fraction * static_cast<double>(grey.total()));
  int below = 0;
  for (int level = 0; level < 256; ++level) {
    below += histogram[static_cast<std::size_t>(level)];
    if (below > wanted) return level;
  }
  return 255;
}

bool corners_are_dark(const cv::Mat& bright) {
  const int side = std::max(2, bright.cols / kCornerFraction);
  int dark = 0;
  for (const int x : {0, bright.cols - side}) {
    for (const int y : {0, bright.rows - side}) {
      const double lit = cv::countNonZero(bright(cv::Rect(x, y, side, side)));
      if (lit <= (1.0 - kCornerDark) * side * side) ++dark;
    }
  }
  return dark == 4;
}

/// The largest bright region's outline; empty when there is none.
std::vector<cv::Point> largest_outline(const cv::Mat& bright) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(bright, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  if (outlines.empty()) return {};
  return *std::max_element(outlines.begin(), outlines.end(), [](const auto& a, const auto& b) {
    return cv::contourArea(a) < cv::contourArea(b);
  });
}

bool is_disc(const std::vector<cv::Point>& outline, cv::Size size) {
  const double area = cv::contourArea(outline);
  if (area < kMinArea * size.area()) return false;
  cv::Point2f centre;
  float radius = 0;
  cv::minEnclosingCircle(outline, centre, radius);
  // Only what of the circle lies within the frame can be bright.
  cv::Mat circle = cv::Mat::zeros(size, CV_8UC1);
  cv::circle(circle, centre, cvRound(radius), 255, cv::FILLED);
  std::vector<cv::Point> hull;
  cv::convexHull(outline, hull);
  return area > kMinRoundness * cv::countNonZero(circle) &&
         area > kMinSolidity * cv::contourArea(hull);
}

cv::Mat ellipse(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

}  // namespace

cv::Mat find_field_of_view(const cv::Mat& grey) {
  const double scale = std::min(1.0, static_cast<double>(kWorkingWidth) / grey.cols);
  cv::Mat small;
  cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  const int bright_level = grey_quantile(small, kBrightQuantile);
  if (bright_level < kTooDark) return {};
  const int threshold = std::max(kDarkFloor, static_cast<int>(kDarkFraction * bright_level));
  cv::Mat bright = small > threshold;
  if (!corners_are_dark(bright)) return {};

  const int close = cvRound(kCloseFraction * small.cols);
  cv::copyMakeBorder(bright, bright, close, close, close, close, cv::BORDER_CONSTANT, 0);
  cv::morphologyEx(bright, bright, cv::MORPH_OPEN, ellipse(2));
  cv::morphologyEx(bright, bright, cv::MORPH_CLOSE, ellipse(close));
  const auto outline = largest_outline(bright);
  if (outline.empty() || !is_disc(outline, bright.size())) return {};

  cv::Mat disc = cv::Mat::zeros(bright.size(), CV_8UC1);
  cv::drawContours(disc, std::vector<std::vector<cv::Point>>{outline}, 0, 255, cv::FILLED);
  disc = disc(cv::Rect({close, close}, small.size())).clone();
  const double radius_px = std::sqrt(cv::contourArea(outline) / CV_PI);
  const int erode = std::max(2, cvRound(kErodeFraction * radius_px));
  cv::erode(disc, disc, ellipse(erode));
  cv::Mat mask;
  cv::resize(disc, mask, grey.size(), 0, 0, cv::INTER_LINEAR);
  return mask > 254;
}

}  // namespace handeye
