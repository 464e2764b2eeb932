// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/handeye/one_step/metric_scene.hpp"

namespace handeye {

/// An observation linearised, in px, weighted by the square root of the loss's weight. With the
/// point P and the eye's centre C in the room, d = P - C: the pixel moves by A dP - A dC + A [d]x
/// w.
struct ImageRow {
  Eigen::Matrix<double, 2, 3> by_point;  ///< A
  Eigen::Vector3d point_from_eye_mm;     ///< d, in the room's directions
  Eigen::Vector2d error;
  Eigen::Matrix<double, 2, kLensParameters> by_lens;  ///< only where the lens is free
};

using Matrix26 = Eigen::Matrix<double, 2, 6>;
/// By (w, dC) of the keyframe that sees it.
Matrix26 pixel_by_eye(const ImageRow& row);

/// All observations at a state.
struct ImageRows {
  std::vector<ImageRow> rows;  ///< as MetricScene::observations
  double cost{0};              ///< sum of Huber's loss [px^2]
  double weighted_squares{0};  ///< [px^2]
  double squares{0};           ///< without any weight [px^2]
  /// Of each point's observations, by the loss's weight alone [px^2].
  std::vector<double> squares_of_tracks;
};

/// Nothing where a point is behind an eye that sees it, or the lens is none. `huber_px`: of the
/// norm of an error of a track whose weight is 1; `track_weights`: of the squares, one a point.
/// `rows` is overwritten: its memory is used again.
bool linearise(const MetricScene& scene, const MetricState& state,
               const std::vector<double>& track_weights, double huber_px, bool lens_free,
               ImageRows& rows);

/// The gradient of the cost [px^2] by all unknowns.
struct ImageGradient {
  Eigen::VectorXd of_unknowns;             ///< keyframes and common
  std::vector<Eigen::Vector3d> of_points;  ///< one a point
};
ImageGradient gradient_of(const MetricScene& scene, const ImageRows& rows, bool lens_free);

/// Norms of all errors [px].
std::vector<double> error_norms(const MetricScene& scene, const MetricState& state);

}  // namespace handeye
