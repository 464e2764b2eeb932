// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace handeye {

/// What is wrong with an image as a whole, if anything.
enum class ImageCondition {
  kGood,
  kDark,        ///< nothing to be seen: lens cap, light off, black picture
  kBright,      ///< burnt out over most of the field of view
  kFrozen,      ///< the last image once more: no new information, whatever its time stamp says
  kInterlaced,  ///< two fields of different instants woven together; one of them was used
  kBlurred,     ///< far less sharp than those before it
};

inline constexpr int kImageConditions = 6;

/// "good", "dark", ...
std::string_view condition_word(ImageCondition condition);

/// Whether such an image says nothing about where the camera is at its time.
constexpr bool shows_nothing(ImageCondition condition) {
  return condition == ImageCondition::kDark || condition == ImageCondition::kFrozen;
}

}  // namespace handeye
