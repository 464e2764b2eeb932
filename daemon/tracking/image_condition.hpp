// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace handeye {

/// What is wrong with an image as a whole, if anything.
enum class ImageCondition {
  kGood,
  kDark,        ///< nothing to be seen: lens cap, light off, black picture
  kBright,      ///< burnt out over most of the field of view
  kFrozen,      ///< the last image once more: no new information, whatever its time stamp says
  kInterlaced,  ///< two fields of different instants woven together; one of them was used
  kBlurred,     ///< far less sharp than those before it
  kUnusable,    ///< empty, not of 8 bit grey, or one that could not be worked on
};

inline constexpr int kImageConditions = 7;

/// Whether such an image says nothing about where the camera is at its time.
constexpr bool shows_nothing(ImageCondition condition) {
  return condition == ImageCondition::kDark || condition == ImageCondition::kFrozen ||
         condition == ImageCondition::kUnusable;
}

}  // namespace handeye
