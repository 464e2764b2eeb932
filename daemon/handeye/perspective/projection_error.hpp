// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Geometry>
#include <ceres/jet.h>
#include <ceres/rotation.h>

#include "daemon/handeye/perspective/lens.hpp"
#include "daemon/handeye/perspective/refinement.hpp"

/// The residuals of ProjectionProblem, for Ceres to differentiate.
namespace handeye {
namespace projection {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

inline double value_of(double x) {
  return x;
}
template <typename T, int n>
double value_of(const ceres::Jet<T, n>& x) {
  return x.a;
}

inline bool is_finite(double x) {
  return std::isfinite(x);
}
template <typename T, int n>
bool is_finite(const ceres::Jet<T, n>& x) {
  return std::isfinite(x.a) && x.v.allFinite();
}

/// distorted_radius with its derivatives: one step of Newton's method from the exact value. False
/// where no radius is seen there.
template <typename T>
bool distort_radius(const T& k1_per_mm2, const T& undistorted_mm, T& distorted_mm) {
  const double r = distorted_radius(value_of(k1_per_mm2), value_of(undistorted_mm));
  const T slope = 1.0 + 3.0 * k1_per_mm2 * r * r;
  constexpr double kFold = 1e-3;
  if (!(value_of(slope) > kFold)) return false;
  distorted_mm = r - (r * (1.0 + k1_per_mm2 * r * r) - undistorted_mm) / slope;
  return true;
}

}  // namespace projection

/// Residual of one point, in units of the image noise.
struct ProjectionError {
  ObjectPoint point;
  Pose hand_from_hand1;  // A^-1
  Eigen::Vector2d pixel_mm;
  double image_noise_px;

  template <typename T>
  bool operator()(const T* object_from_hand_q, const T* object_from_hand_t,
                  const T* hand_from_eye_q, const T* hand_from_eye_t, const T* camera,
                  const T* deviation, T* residual) const {
    using Quaternion = Eigen::Quaternion<T>;
    const projection::Vector3<T> in_object = point.object_mm.cast<T>();
    const projection::Vector3<T> in_hand1 =
        Eigen::Map<const Quaternion>(object_from_hand_q).conjugate() *
        projection::Vector3<T>(in_object -
                               Eigen::Map<const projection::Vector3<T>>(object_from_hand_t));
    const projection::Vector3<T> measured =
        hand_from_hand1.linear().cast<T>() * in_hand1 + hand_from_hand1.translation().cast<T>();
    projection::Vector3<T> in_hand;
    ceres::AngleAxisRotatePoint(deviation, measured.data(), in_hand.data());
    in_hand += Eigen::Map<const projection::Vector3<T>>(deviation + 3);
    const projection::Vector3<T> in_eye =
        Eigen::Map<const Quaternion>(hand_from_eye_q).conjugate() *
        projection::Vector3<T>(in_hand - Eigen::Map<const projection::Vector3<T>>(hand_from_eye_t));
    if (!(projection::value_of(in_eye.z()) > 0.0)) return false;

    const T& fx = camera[0];
    const T& fy = camera[1];
    const T x_mm = fx * pixel_mm.x() * in_eye.x() / in_eye.z();
    const T y_mm = fy * pixel_mm.y() * in_eye.y() / in_eye.z();
    T ratio(1.0);
    const T r2 = x_mm * x_mm + y_mm * y_mm;
    if (projection::value_of(r2) > 0.0) {
      const T undistorted = sqrt(r2);
      T distorted;
      if (!projection::distort_radius(camera[4], undistorted, distorted)) return false;
      ratio = distorted / undistorted;
    }
    residual[0] = (ratio * x_mm / pixel_mm.x() + camera[2] - point.pixel.x()) / image_noise_px;
    residual[1] = (ratio * y_mm / pixel_mm.y() + camera[3] - point.pixel.y()) / image_noise_px;
    // Ceres would complain on stderr where a residual is not finite; so it is told.
    return projection::is_finite(residual[0]) && projection::is_finite(residual[1]);
  }
};

/// A hand pose's deviation in units of the hand's noise.
struct DeviationError {
  HandNoise noise;

  template <typename T>
  bool operator()(const T* deviation, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      residual[i] = deviation[i] / noise.rotation_rad;
      residual[i + 3] = deviation[i + 3] / noise.translation_mm;
    }
    return true;
  }
};

}  // namespace handeye
