// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/methods.hpp"

#include <array>

namespace handeye {
namespace {

constexpr std::array<Method, 1> kKnownScale{{
    {"horaud_nonlinear", horaud_nonlinear, "Horaud, Dornaika 1995, non-linear"},
}};

constexpr std::array<Method, 6> kUnknownScale{{
    {"dq_scale_separate", dq_scale_separate,
     "Schmidt, Vogt, Niemann 2005, eqs 4 and 6; Daniilidis 1999"},
    {"horaud_scale_separate", horaud_scale_separate,
     "Schmidt, Vogt, Niemann 2005, eqs 4 and 6; Horaud, Dornaika 1995, non-linear"},
    {"nonlinear_quaternion", nonlinear_quaternion, "Schmidt, Vogt, Niemann 2005, eq 7"},
    {"nonlinear_dual_quaternion", nonlinear_dual_quaternion, "Schmidt, Vogt, Niemann 2005, eq 15"},
    {"andreff", andreff, "Andreff, Horaud, Espiau 2001; Schmidt, Vogt, Niemann 2005, section 5"},
    {"maximum_likelihood", maximum_likelihood_unknown_scale, "ours: over poses, weighted by noise"},
}};

}  // namespace

std::span<const Method> methods(ScaleMode scale) {
  if (scale == ScaleMode::kKnown) return kKnownScale;
  return kUnknownScale;
}

}  // namespace handeye
