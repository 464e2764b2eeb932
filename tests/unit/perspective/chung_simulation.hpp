// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/perspective/gauss_newton.hpp"
#include "daemon/handeye/perspective/observations.hpp"

/// The computer simulation of Chung's paper (its Table 1, and the hand-eye and movements printed
/// there), and its printed results (Table 2). Also used by the paper's reproduction.
namespace handeye::test::chung {

/// A box of points on a regular grid, in the object's frame. The paper does not give its object:
/// this one, 225 x 233 x 300 mm behind the plane z = 0, fills the image.
struct CalibrationObject {
  Eigen::Vector3d from_mm{-220.0, -111.0, -300.0};
  Eigen::Vector3d to_mm{5.0, 122.0, 0.0};
  Eigen::Vector3i count{9, 9, 4};

  std::vector<Eigen::Vector3d> points_mm() const;
};

inline constexpr double kFocalLength_mm = 25.426478;
inline constexpr double kK1_per_mm2 = 0.000432;
inline constexpr int kWidth = 512;
inline constexpr int kHeight = 512;

/// Size of a pixel of the stored image: 768 elements of 8.6 um, sampled 752 times a line, and the
/// horizontal scale 1.011; 8.3 um from line to line.
Eigen::Vector2d pixel_mm();
SensorLens lens();

Pose eye1_from_object();
Pose hand_from_eye();
/// A_1 = identity, A_2, A_3.
std::vector<Pose> hand1_from_hands();

/// Y = object_from_hand1 by composition.
Pose object_from_hand();

/// Gibbs vector and translation of Y, as Table 2 lists them.
using YVector = Eigen::Matrix<double, 6, 1>;
YVector y_vector(const Pose& object_from_hand);
Pose pose_of(const YVector& y);

/// Table 2.
YVector printed_ideal();
YVector printed_distortion_ignored();
YVector printed_compensated();

/// Exact matrices M_i, normalised.
std::vector<PerspectiveMatrix> matrices();

/// Noise-free projections; distorted unless k1_per_mm2 is 0.
Observations observe(const CalibrationObject& object, double k1_per_mm2 = kK1_per_mm2);

/// The true values of everything the distortion-inside iteration estimates.
PerspectiveState truth();

}  // namespace handeye::test::chung
