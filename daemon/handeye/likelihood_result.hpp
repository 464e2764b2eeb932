// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/part_agreement.hpp"
#include "daemon/handeye/pose_problem.hpp"

namespace handeye {

/// What a solved problem says, and how certain it is. `noise`: as last fitted.
MaximumLikelihoodResult describe(const PoseProblem& problem, const PartNoise& noise,
                                 const PartAgreement& agreement,
                                 const MaximumLikelihoodOptions& options);

}  // namespace handeye
