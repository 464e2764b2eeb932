// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/tracking/image_condition.hpp"

namespace handeye {

/// What ailed a calibration's images: how many in all, and what does now.
class ImageHealth {
 public:
  void add(ImageCondition condition);

  std::int64_t count(ImageCondition condition) const {
    return counts_[static_cast<std::size_t>(condition)];
  }

  /// What ails most of the last images; kGood: nothing does, or now this, now that. Interlacing is
  /// dealt with and not an ailment; a repeated picture now and then (a grabber faster than its
  /// camera) neither.
  ImageCondition recent() const;

  /// What most of all images so far were, if they were dark or frozen; else kGood.
  ImageCondition prevailing() const;

 private:
  static constexpr std::size_t kRecent = 16;

  std::array<std::int64_t, kImageConditions> counts_{};
  std::array<ImageCondition, kRecent> last_{};
  std::size_t next_{0};
};

}  // namespace handeye
