// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/tracking/image_condition.hpp"

namespace handeye {

/// What ailed a calibration's images: how many in all, and what does now.
///
/// A grabber that is faster than its camera repeats most of its pictures; that is no ailment. A
/// picture is stuck only when it came again many times on end.
class ImageHealth {
 public:
  void add(ImageCondition condition);

  std::int64_t count(ImageCondition condition) const {
    return counts_[static_cast<std::size_t>(condition)];
  }

  /// What ails most of the last images, for kFrozen: all of them; kGood: nothing does, or now this,
  /// now that. Interlacing is dealt with and not an ailment.
  ImageCondition recent() const;

  /// Whether one of the last images was interlaced.
  bool recently_interlaced() const;

  /// What most of all images so far were, if they were unusable, dark or stuck (kFrozen); else
  /// kGood.
  ImageCondition prevailing() const;

 private:
  static constexpr std::size_t kRecent = 16;

  std::array<std::int64_t, kImageConditions> counts_{};
  std::array<ImageCondition, kRecent> last_{};
  std::size_t next_{0};
  std::int64_t repeats_on_end_{0};
  std::int64_t stuck_{0};  ///< images of runs of repeats long enough
};

}  // namespace handeye
