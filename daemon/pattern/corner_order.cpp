// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/corner_order.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handeye {
namespace {

// Mean difference between dark and light squares [grey levels] below which it is no chessboard.
constexpr double kFaintestContrast = 8;
// A turn since the last image up to this share of what would be ambiguous is believed.
constexpr double kBelievedTurn = 2.0 / 3.0;
// A second of a slow camera's images: what was seen before them says nothing any more.
constexpr int kForgetAfter = 25;

double angle_between(const cv::Point2f& a, const cv::Point2f& b) {
  return std::abs(std::atan2(a.cross(b), a.dot(b)));
}

}  // namespace

const cv::Point2f& CornerOrder::at(const Corners& corners, int column, int row) const {
  return corners[static_cast<std::size_t>(row * columns_ + column)];
}

bool CornerOrder::arrange(const cv::Mat& grey, std::vector<cv::Point2f>& corners) {
  make_right_handed(corners);
  std::vector<Corners> candidates{corners, turned_half(corners)};
  if (columns_ == rows_) {
    candidates.push_back(turned_quarter(corners));
    candidates.push_back(turned_half(candidates.back()));
  }
  std::erase_if(candidates, [&](const Corners& candidate) {
    return contrast(grey, candidate) < kFaintestContrast;
  });
  if (candidates.empty()) return false;

  const cv::Point2f wanted = last_direction_.value_or(cv::Point2f(1, 0));
  const auto turn = [&](const Corners& candidate) {
    return angle_between(wanted, first_row_direction(candidate));
  };
  corners = *std::ranges::min_element(candidates, {}, turn);
  const double half_step = std::numbers::pi / static_cast<double>(candidates.size());
  const bool ambiguous = candidates.size() > 1;
  if (ambiguous && last_direction_ && turn(corners) > kBelievedTurn * half_step) {
    if (++refused_ >= kForgetAfter) last_direction_.reset();
    return false;
  }
  refused_ = 0;
  last_direction_ = first_row_direction(corners);
  return true;
}

void CornerOrder::make_right_handed(Corners& corners) const {
  const cv::Point2f& first = corners.front();
  const cv::Point2f x = at(corners, columns_ - 1, 0) - first;
  const cv::Point2f y = at(corners, 0, rows_ - 1) - first;
  if (x.cross(y) > 0) return;
  for (int row = 0; row < rows_ / 2; ++row) {
    std::swap_ranges(corners.begin() + row * columns_, corners.begin() + (row + 1) * columns_,
                     corners.begin() + (rows_ - 1 - row) * columns_);
  }
}

/// Mean of the squares that must be light minus that of those that must be dark.
double CornerOrder::contrast(const cv::Mat& grey, const Corners& corners) const {
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  for (int row = 0; row + 1 < rows_; ++row) {
    for (int column = 0; column + 1 < columns_; ++column) {
      const cv::Point2f centre =
          0.25F * (at(corners, column, row) + at(corners, column + 1, row) +
                   at(corners, column, row + 1) + at(corners, column + 1, row + 1));
      const cv::Point pixel(cvRound(centre.x), cvRound(centre.y));
      if (!cv::Rect(cv::Point(), grey.size()).contains(pixel)) continue;
      const int odd = (row + column) % 2;
      sum[odd] += grey.at<std::uint8_t>(pixel);
      ++count[odd];
    }
  }
  // With 2x2 corners there is one square: it is compared with mid-grey.
  if (count[0] == 0) return 0;
  constexpr double kMidGrey = 128;
  return (count[1] == 0 ? kMidGrey : sum[1] / count[1]) - sum[0] / count[0];
}

CornerOrder::Corners CornerOrder::turned_half(const Corners& corners) const {
  return {corners.rbegin(), corners.rend()};
}

/// Square boards: the new first row is the old last column.
CornerOrder::Corners CornerOrder::turned_quarter(const Corners& corners) const {
  Corners turned;
  turned.reserve(corners.size());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      turned.push_back(at(corners, columns_ - 1 - row, column));
    }
  }
  return turned;
}

cv::Point2f CornerOrder::first_row_direction(const Corners& corners) const {
  return at(corners, columns_ - 1, 0) - corners.front();
}

}  // namespace handeye
