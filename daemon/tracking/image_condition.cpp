// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/image_condition.hpp"

namespace handeye {

std::string_view condition_word(ImageCondition condition) {
  switch (condition) {
    case ImageCondition::kGood:
      return "good";
    case ImageCondition::kDark:
      return "dark";
    case ImageCondition::kBright:
      return "bright";
    case ImageCondition::kFrozen:
      return "frozen";
    case ImageCondition::kInterlaced:
      return "interlaced";
    case ImageCondition::kBlurred:
      break;
  }
  return "blurred";
}

}  // namespace handeye
