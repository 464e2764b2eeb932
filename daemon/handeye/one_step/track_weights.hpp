// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/one_step/image_rows.hpp"

namespace handeye {

/// How much each track's observations count: a few in a hundred tracks, at edges that slide, on
/// highlights, on what moves by itself, have most of all the errors, all along the track. A
/// track's variance is image_px^2 over its weight. The variances are taken to scatter so that the
/// errors follow Student's distribution, with as many degrees of freedom as their scatter shows;
/// the weights are the expectation, given the errors (Lange, Little, Taylor 1989). All 1 where
/// tracks differ no more than by chance. One a point of the scene.
std::vector<double> track_weights(const MetricScene& scene, const ImageRows& rows, double image_px);

/// Whether counting tracks so instead would change what the images say.
bool differ(const std::vector<double>& weights, const std::vector<double>& others);

}  // namespace handeye
