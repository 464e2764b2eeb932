// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_motions.hpp"

#include <cmath>

namespace handeye::synthetic {
namespace {

/// Three smooth signals within +-1.
Eigen::Vector3d swings(double time_s, double phase) {
  const auto swing = [&](double hz, double shift) {
    return std::sin(2 * kPi * hz * time_s + shift + phase);
  };
  return {0.6 * swing(0.33, 0.2) + 0.4 * swing(0.51, 1.0),
          0.6 * swing(0.25, 2.0) + 0.4 * swing(0.46, 0.4),
          0.6 * swing(0.39, 4.0) + 0.4 * swing(0.59, 2.2)};
}

}  // namespace

Motion shaped_motion(const MotionShape& shape) {
  return [shape](double time_s) {
    const Eigen::Vector3d turn = shape.turn_deg.cwiseProduct(swings(time_s, 0));
    const Eigen::Vector3d slide = shape.slide_mm.cwiseProduct(swings(0.88 * time_s, 1.7));
    const Eigen::Matrix3d rotation = exp_so3(turn * rad_from_deg(1));
    Pose in_first_eye = Pose::Identity();
    in_first_eye.linear() = rotation;
    in_first_eye.translation() = shape.centre_in_eye_mm - rotation * shape.centre_in_eye_mm + slide;
    return still(0) * in_first_eye;
  };
}

}  // namespace handeye::synthetic
