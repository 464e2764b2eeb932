// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/image_health.hpp"

#include <algorithm>
#include <numeric>

namespace handeye {
namespace {

constexpr double kMostOfRecent = 0.7;
constexpr double kMostOfAll = 0.6;

}  // namespace

void ImageHealth::add(ImageCondition condition) {
  ++counts_[static_cast<std::size_t>(condition)];
  last_[next_] = condition;
  next_ = (next_ + 1) % last_.size();
}

ImageCondition ImageHealth::recent() const {
  for (const ImageCondition ailment : {ImageCondition::kDark, ImageCondition::kFrozen,
                                       ImageCondition::kBright, ImageCondition::kBlurred}) {
    const auto ailing = std::ranges::count(last_, ailment);
    if (static_cast<double>(ailing) > kMostOfRecent * kRecent) return ailment;
  }
  return ImageCondition::kGood;
}

ImageCondition ImageHealth::prevailing() const {
  const auto all = std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
  const std::int64_t dark = count(ImageCondition::kDark);
  const std::int64_t frozen = count(ImageCondition::kFrozen);
  if (static_cast<double>(dark + frozen) <= kMostOfAll * static_cast<double>(all)) {
    return ImageCondition::kGood;
  }
  return dark >= frozen ? ImageCondition::kDark : ImageCondition::kFrozen;
}

}  // namespace handeye
