// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace handeye {

/// Tracks that move together as one rigid body does under an affine camera: the columns of `rays`
/// (2F x P, as for `factorise`) that lie near one three-dimensional affine subspace. Samples of
/// four tracks, then least trimmed squares over the majority (Rousseeuw & Van Driessen 1999);
/// withstands 40 % of others, be they a body of their own. What perspective adds widens the scale
/// of the residuals, which is measured. `noise`: below this residual (rms per coordinate,
/// normalised) a track always belongs. Returns positions of columns, ascending. Deterministic.
std::vector<Eigen::Index> consistent_tracks(const Eigen::MatrixXd& rays, double noise);

}  // namespace handeye
