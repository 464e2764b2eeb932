// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods.hpp"

#include <array>

namespace handeye {

std::span<const Method> unknown_scale_methods() {
  static constexpr std::array<Method, 2> kMethods{{
      {"dq_scale_separate", dq_scale_separate,
       "Schmidt, Vogt, Niemann 2005, eqs 4 and 6; Daniilidis 1999"},
      {"andreff", andreff, "Andreff, Horaud, Espiau 2001; Schmidt, Vogt, Niemann 2005, section 5"},
  }};
  return kMethods;
}

}  // namespace handeye
