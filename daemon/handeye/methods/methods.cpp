// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/methods.hpp"

#include <array>

namespace handeye {
namespace {

constexpr std::array<Method, 10> kKnownScale{{
    {"tsai_lenz", tsai_lenz, "Tsai, Lenz 1989, eqs 12 and 15", ErrorModel::kGibbsVector},
    {"shiu_ahmad", shiu_ahmad, "Shiu, Ahmad 1989", ErrorModel::kAxisFrames},
    {"chou_kamel", chou_kamel, "Chou, Kamel 1991", ErrorModel::kQuaternions},
    {"chen", chen, "Chen 1991", ErrorModel::kScrews},
    {"park_martin", park_martin, "Park, Martin 1994, eq 19", ErrorModel::kLogarithms},
    {"horaud_closed_form", horaud_closed_form, "Horaud, Dornaika 1995, closed form",
     ErrorModel::kQuaternions},
    {"horaud_nonlinear", horaud_nonlinear, "Horaud, Dornaika 1995, non-linear",
     ErrorModel::kQuaternionsJoint},
    {"daniilidis", daniilidis, "Daniilidis 1999, eqs 31 to 36; rows weighted",
     ErrorModel::kDualQuaternions},
    {"andreff", andreff_known_scale, "Andreff, Horaud, Espiau 1999 and 2001; rows weighted",
     ErrorModel::kEntries},
    {"maximum_likelihood", maximum_likelihood_known_scale, "ours: over poses, weighted by noise"},
}};

constexpr std::array<Method, 6> kUnknownScale{{
    {"dq_scale_separate", dq_scale_separate,
     "Schmidt, Vogt, Niemann 2005, eqs 4 and 6; Daniilidis 1999, rows weighted",
     ErrorModel::kScaleDualQuaternions},
    {"horaud_scale_separate", horaud_scale_separate,
     "Schmidt, Vogt, Niemann 2005, eqs 4 and 6; Horaud, Dornaika 1995, non-linear",
     ErrorModel::kScaleQuaternionsJoint},
    {"nonlinear_quaternion", nonlinear_quaternion, "Schmidt, Vogt, Niemann 2005, eq 7",
     ErrorModel::kEquation7},
    {"nonlinear_dual_quaternion", nonlinear_dual_quaternion, "Schmidt, Vogt, Niemann 2005, eq 15",
     ErrorModel::kEquation15},
    {"andreff", andreff, "Andreff, Horaud, Espiau 2001; Schmidt, Vogt, Niemann 2005, section 5",
     ErrorModel::kEntriesJoint},
    {"maximum_likelihood", maximum_likelihood_unknown_scale, "ours: over poses, weighted by noise"},
}};

}  // namespace

std::span<const Method> methods(ScaleMode scale) {
  if (scale == ScaleMode::kKnown) return kKnownScale;
  return kUnknownScale;
}

}  // namespace handeye
