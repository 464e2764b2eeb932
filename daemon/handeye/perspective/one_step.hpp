// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "daemon/handeye/perspective/observations.hpp"
#include "daemon/handeye/perspective/perspective_matrix.hpp"
#include "daemon/handeye/perspective/refinement.hpp"

/// One-step hand-eye calibration from perspective matrices (seed 2: Chung, after Horaud and
/// Dornaika 1995): camera and hand-eye together, with or without the lens distortion inside.
/// Not to be mixed up with the method `one_step`, which needs no pattern.
namespace handeye {

/// Where the iteration begins; what is left out is found from the observations. For a plane, centre
/// and k1 are taken together with the matrices only.
struct PerspectiveStart {
  std::optional<Pose> object_from_hand;  ///< Y, mm
  std::optional<Eigen::Vector2d> centre_px;
  std::optional<double> k1_per_mm2;
  std::vector<PerspectiveMatrix> matrices;  ///< empty, or one a position
};

struct PerspectiveOptions {
  bool distortion_inside{true};  ///< false: as if the lens did not distort
  PerspectiveStart start;
};

struct PerspectiveCalibration {
  /// Of a pixel: as given, or with the width for which the lens is round where the images show so.
  Eigen::Vector2d pixel_mm{0.0, 0.0};
  RefinedCalibration refined;  ///< the answer
  PerspectiveSigma sigma;
  int iterations{0};                            ///< Gauss-Newton steps of the matrix method
  std::optional<Pose> matrix_object_from_hand;  ///< Y of the matrix method, before refinement
  std::vector<std::size_t> left_out;            ///< gross outliers: places among all the points
  std::vector<PerspectiveMatrix> matrices;      ///< M_i of the matrix method
};

/// Gauss-Newton on the matrices (a plane: from Zhang's), X from M_1 Y = K X, then refinement; all
/// of it again without the points that come out as gross outliers, until there are none.
std::variant<PerspectiveCalibration, PerspectiveRefusal> calibrate_perspective(
    const Observations& observations, const PerspectiveOptions& options);

}  // namespace handeye
