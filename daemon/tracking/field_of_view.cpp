// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/field_of_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "daemon/tracking/field_outline.hpp"

namespace handeye {
namespace {

constexpr int kWorkingWidth = 320;  ///< px; the disc is large, details only disturb
constexpr double kBrightQuantile = 0.95;
constexpr int kTooDark = 40;  ///< grey; an image whose bright parts are darker tells nothing
constexpr double kDarkFraction =
    0.1;                        ///< surroundings are darker than this share of the bright parts
constexpr int kDarkFloor = 10;  ///< grey; noise of real cameras
constexpr double kBlackQuantile = 0.01;
constexpr int kHighestBlack = 24;  ///< grey; black is 16 in video, and glows a little
/// Of the disc's radius: the rim's glow grows with the disc.
constexpr double kErodeFraction = 0.04;
/// Share of the images that must show a pixel lit: a flare or two do not widen the field.
constexpr double kLitShare = 0.15;
constexpr int kFrequentVotes = 8;  ///< in a row; then ever more images are passed over
constexpr int kMostSkipped = 16;
/// Then all votes count half: a field that changed shows within a minute, a wider one in seconds.
constexpr int kMostVotes = 32;
/// Fields that agree better than this (intersection over union) are the same.
constexpr double kSameField = 0.95;
/// Share of what lies outside the field that must be lit for there to be none.
constexpr double kLitOutside = 0.2;

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

void fill(const std::vector<cv::Point>& outline, cv::Size size, cv::Mat& region) {
  region.create(size, CV_8UC1);
  region.setTo(0);
  cv::drawContours(region, std::vector<std::vector<cv::Point>>{outline}, 0, 255, cv::FILLED);
}

/// Away from the rim, in the image's size.
cv::Mat mask_of(const cv::Mat& field, cv::Size size) {
  const double radius_px = std::sqrt(cv::countNonZero(field) / CV_PI);
  cv::Mat from_rim;
  cv::distanceTransform(field, from_rim, cv::DIST_L2, cv::DIST_MASK_5);
  const cv::Mat inner = from_rim > std::max(2.0, kErodeFraction * radius_px);
  cv::Mat mask;
  cv::resize(inner, mask, size, 0, 0, cv::INTER_LINEAR);
  return mask > 254;
}

}  // namespace

FieldOfView::FieldOfView(cv::Mat given) : given_(!given.empty()), mask_(std::move(given)) {}

const cv::Mat& FieldOfView::look(const cv::Mat& grey) {
  if (!given_ && is_due() && vote(grey)) reconsider(grey.size());
  return mask_;
}

bool FieldOfView::is_due() {
  if (frames_to_skip_-- > 0) return false;
  frames_to_skip_ = votes_ < kFrequentVotes ? 0 : std::min(votes_, kMostSkipped);
  return true;
}

/// False: the image is too dark to tell.
bool FieldOfView::vote(const cv::Mat& grey) {
  const double scale = std::min(1.0, static_cast<double>(kWorkingWidth) / grey.cols);
  cv::resize(grey, small_, {}, scale, scale, cv::INTER_AREA);
  const int bright_level = grey_quantile(small_, kBrightQuantile);
  if (bright_level < kTooDark) return false;
  if (lit_votes_.size() != small_.size()) {
    lit_votes_ = cv::Mat1f::zeros(small_.size());
    brightness_ = cv::Mat1f::zeros(small_.size());
    votes_ = 0;
  }
  const int black = std::min(kHighestBlack, grey_quantile(small_, kBlackQuantile));
  const int threshold =
      std::max(kDarkFloor, black + static_cast<int>(kDarkFraction * (bright_level - black)));
  for (int y = 0; y < small_.rows; ++y) {
    const auto* row = small_.ptr<std::uint8_t>(y);
    for (int x = 0; x < small_.cols; ++x) {
      lit_votes_(y, x) += row[x] > threshold ? 1.0F : 0.0F;
      brightness_(y, x) += static_cast<float>(std::max(0, row[x] - black)) /
                           static_cast<float>(bright_level - black);
    }
  }
  if (++votes_ == kMostVotes) forget_half();
  return true;
}

void FieldOfView::forget_half() {
  votes_ /= 2;
  lit_votes_ *= 0.5;
  brightness_ *= 0.5;
}

bool FieldOfView::is_as_before() {
  if (field_.empty()) return false;
  cv::bitwise_and(found_, field_, common_);
  const int common = cv::countNonZero(common_);
  return common > kSameField * (cv::countNonZero(found_) + cv::countNonZero(field_) - common);
}

/// Whether so much is lit outside the field that there is none.
bool FieldOfView::is_lit_outside() {
  cv::bitwise_and(lit_, field_, common_);
  const int lit_outside = cv::countNonZero(lit_) - cv::countNonZero(common_);
  return lit_outside >= kLitOutside * (static_cast<int>(field_.total()) - cv::countNonZero(field_));
}

void FieldOfView::reconsider(cv::Size size) {
  cv::compare(lit_votes_, std::max(1.0, kLitShare * votes_), lit_, cv::CMP_GE);
  const auto outline = find_field_outline(lit_, brightness_);
  if (!outline.empty()) {
    fill(outline, lit_.size(), found_);
    if (is_as_before()) return;
    found_.copyTo(field_);
    mask_ = mask_of(field_, size);
  } else if (!field_.empty() && is_lit_outside()) {
    field_.release();
    mask_.release();
  }
}

}  // namespace handeye
