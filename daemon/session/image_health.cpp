// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/image_health.hpp"

#include <algorithm>
#include <numeric>

namespace handeye {
namespace {

constexpr double kMostOfRecent = 0.7;
constexpr double kMostOfAll = 0.6;
// A 60 Hz grabber on a source of 5 Hz repeats every picture eleven times.
constexpr std::int64_t kStuckRepeats = 12;

}  // namespace

void ImageHealth::add(ImageCondition condition) {
  ++counts_[static_cast<std::size_t>(condition)];
  last_[next_] = condition;
  next_ = (next_ + 1) % last_.size();
  repeats_on_end_ = condition == ImageCondition::kFrozen ? repeats_on_end_ + 1 : 0;
  if (repeats_on_end_ == kStuckRepeats) {
    stuck_ += kStuckRepeats;
  } else if (repeats_on_end_ > kStuckRepeats) {
    ++stuck_;
  }
}

ImageCondition ImageHealth::recent() const {
  if (repeats_on_end_ >= kStuckRepeats) return ImageCondition::kFrozen;
  for (const ImageCondition ailment : {ImageCondition::kUnusable, ImageCondition::kDark,
                                       ImageCondition::kBright, ImageCondition::kBlurred}) {
    const auto ailing = std::ranges::count(last_, ailment);
    if (static_cast<double>(ailing) > kMostOfRecent * kRecent) return ailment;
  }
  return ImageCondition::kGood;
}

bool ImageHealth::recently_interlaced() const {
  return std::ranges::count(last_, ImageCondition::kInterlaced) > 0;
}

ImageCondition ImageHealth::prevailing() const {
  const auto all = std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
  const std::int64_t unusable = count(ImageCondition::kUnusable);
  const std::int64_t dark = count(ImageCondition::kDark);
  if (static_cast<double>(unusable + dark + stuck_) <= kMostOfAll * static_cast<double>(all)) {
    return ImageCondition::kGood;
  }
  if (unusable >= std::max(dark, stuck_)) return ImageCondition::kUnusable;
  return dark >= stuck_ ? ImageCondition::kDark : ImageCondition::kFrozen;
}

}  // namespace handeye
