// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/repeated_image.hpp"

#include <algorithm>
#include <cstdlib>

namespace handeye {
namespace {

constexpr int kRows = 60;  ///< looked at, or a few more
/// Neither black nor burnt out: only there can a live picture be told from a repeated one.
constexpr int kBlack = 12;
constexpr int kBurnt = 245;
/// Coding a picture once more changes up to 0.7 % of the pixels by more than this, a grabber's
/// noise of half a grey level 0.3 %. A live picture that stands still changes 6 % at a noise of
/// only 0.5 grey levels, 30 % at 1.0, whether stored as it is or as JPEG of any quality above 50.
constexpr int kRounding = 1;
constexpr double kChangedShare = 0.02;

/// Odd, so that both fields are seen of an interlaced picture, and every line of a coder's blocks.
int row_step(int rows) {
  return std::max(1, rows / kRows) | 1;
}

/// With fewer pixels to compare nothing is said, as a share of those looked at.
constexpr double kEnough = 0.005;

struct Comparison {
  int compared{0};
  int changed{0};
};

void compare_row(const std::uint8_t* now, const std::uint8_t* before, int columns,
                 Comparison& comparison) {
  int compared = 0;
  int changed = 0;
  for (int x = 0; x < columns; ++x) {
    const int difference = std::abs(now[x] - before[x]);
    const int counts =
        static_cast<int>(before[x] >= kBlack) & static_cast<int>(before[x] <= kBurnt);
    compared += counts;
    changed += counts & static_cast<int>(difference > kRounding);
  }
  comparison.compared += compared;
  comparison.changed += changed;
}

}  // namespace

bool RepeatedImage::is_repetition(const cv::Mat& grey) {
  if (rows_.empty() || grey.size() != size_) {
    remember(grey);
    return false;
  }
  Comparison comparison;
  const std::uint8_t* before = rows_.data();
  for (int y = 0; y < grey.rows; y += row_step(grey.rows), before += grey.cols) {
    compare_row(grey.ptr<std::uint8_t>(y), before, grey.cols, comparison);
  }
  if (comparison.compared > kEnough * static_cast<double>(rows_.size()) &&
      comparison.changed <= kChangedShare * comparison.compared) {
    return true;
  }
  remember(grey);
  return false;
}

void RepeatedImage::remember(const cv::Mat& grey) {
  size_ = grey.size();
  rows_.clear();
  for (int y = 0; y < grey.rows; y += row_step(grey.rows)) {
    const auto* row = grey.ptr<std::uint8_t>(y);
    rows_.insert(rows_.end(), row, row + grey.cols);
  }
}

}  // namespace handeye
