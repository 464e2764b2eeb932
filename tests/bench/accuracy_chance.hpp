// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// The answer to a sequence, and what other methods make of it.
struct ComparedAnswer {
  Pose hand_from_eye{Pose::Identity()};
  Matrix6d covariance{Matrix6d::Zero()};  ///< of (w [rad], dt [mm]), as in CalibrationResult
  double sigma_rotation_deg{0};
  double sigma_translation_mm{0};
  std::vector<Pose> others;
};

struct Error {
  double rotation_deg{0};
  double translation_mm{0};
};

Error error_of(const Pose& found, const Pose& truth);

/// Whether rotation or translation is further from the truth than in the best of the others,
/// whoever that is in each, by more than the answer's own sigma.
bool is_worse_than_the_best(const ComparedAnswer& answer, const Pose& truth);

/// How probable that is where the answer's covariance is true, and nobody can know better: the
/// truth is drawn about the answer, 4000 times with the same seed, and the others stay where they
/// are. For an efficient estimator this is right: what others are off from it has nothing to do
/// with its own error (Hausman 1978, lemma 2.1). The best of five in hindsight is sometimes lucky.
double chance_of_being_worse(const ComparedAnswer& answer);

/// The probability of so many such sequences or more, where each has this chance of its own.
double chance_of_so_many(int found, const std::vector<double>& chances);

}  // namespace handeye
