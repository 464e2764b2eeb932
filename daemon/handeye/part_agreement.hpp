// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/pose_problem.hpp"

namespace handeye {

/// How well the parts agree on what they have in common, hand_from_eye and the time offset.
struct PartAgreement {
  /// One a part: twice the log likelihood that the common answer costs it against its own, errors
  /// correlated in time allowed for (likelihood ratio). It needs no linearisation: a part that
  /// determines little, say a pivot, has little to contradict.
  std::vector<double> disagreement_chi2;
  /// Of the covariance: by how much all parts together disagree more than chance allows (Birge's
  /// ratio).
  double inflation{1};
};

/// Compares the common answer with each part's own. Leaves out of the problem, and solves again,
/// parts that contradict the others grossly, as a wrong reconstruction does, one after the other,
/// the worst first, as long as another remains. `noise`: as last fitted; fitted again where a part
/// is left out.
PartAgreement leave_out_contradicting_parts(PoseProblem& problem, PartNoise& noise,
                                            const MaximumLikelihoodOptions& options);

}  // namespace handeye
