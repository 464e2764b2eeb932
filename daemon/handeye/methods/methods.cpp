// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/methods.hpp"

#include <array>

namespace handeye {
namespace {

constexpr std::array<Method, 3> kUnknownScale{{
    {"dq_scale_separate", dq_scale_separate,
     "Schmidt, Vogt, Niemann 2005, eqs 4 and 6; Daniilidis 1999"},
    {"andreff", andreff, "Andreff, Horaud, Espiau 2001; Schmidt, Vogt, Niemann 2005, section 5"},
    {"maximum_likelihood", maximum_likelihood_unknown_scale, "ours: over poses, weighted by noise"},
}};

}  // namespace

std::span<const Method> methods(ScaleMode scale) {
  if (scale == ScaleMode::kKnown) return {};
  return kUnknownScale;
}

}  // namespace handeye
