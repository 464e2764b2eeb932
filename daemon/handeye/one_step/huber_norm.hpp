// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace handeye {

/// Huber's loss on the norm of several errors at once, of unit variance each: the norm that as few
/// inliers exceed as exceed `sigmas` standard deviations in one dimension, and what the weighted
/// squares of inliers then are, as a share of the unweighted.
struct HuberNorm {
  double norm{0};
  double share_of_squares{1};
};
HuberNorm huber_norm(int dimensions, double sigmas);

/// The median of the sum of so many squared normal deviates (chi2).
double median_of_squares(int dimensions);

}  // namespace handeye
