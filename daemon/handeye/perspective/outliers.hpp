// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/handeye/perspective/observations.hpp"

namespace handeye {

/// Places of points whose error in the image is gross: beyond six standard deviations of one axis
/// as the median error tells it, which outliers do not move; in 1e8 points of Gaussian noise one is
/// that far. Of these only the worst ones, down to half the largest error. `errors_px`: the length
/// of every point's residual, position by position. Nothing where a position would lose more than
/// half of its points: then it is not the points that are wrong.
std::vector<std::size_t> gross_outliers(const Observations& observations,
                                        std::span<const double> errors_px);

/// The observations without the points at these places, ascending.
Observations without_points(const Observations& observations, std::span<const std::size_t> places);

}  // namespace handeye
