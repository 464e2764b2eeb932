// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/one_step.hpp"
#include "daemon/handeye/types.hpp"

namespace handeye {

/// What the noise of one sample of the tracker would be if all that the likelihood found in hand
/// and eye were the tracker's: the likelihood's is of a pose interpolated between two samples,
/// which has less, and splits the translation's in halves that it cannot tell apart. Of the hand
/// only.
PoseNoise noise_of_samples(const PoseNoise& of_likelihood);

/// Whether an answer fits the tracker as the likelihood's, which has seen less, did: its residuals
/// are no more than twice the noise that explains the likelihood's, and it left out no more than a
/// fifth of the hands, of which chi2 tells nothing. Else it is in a wrong minimum, or the tracker
/// thinks too well of itself. `options`: it was solved with.
bool explains_the_hand(const OneStepResult& result, const OneStepProblem& problem,
                       const OneStepOptions& options, const PoseNoise& of_likelihood);

}  // namespace handeye
