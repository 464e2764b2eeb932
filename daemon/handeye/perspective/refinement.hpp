// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/handeye/perspective/observations.hpp"

/// Non-linear refinement of the one-step calibration on the reprojection error [px], with the
/// distortion of lens.hpp: beyond the seed.
namespace handeye {

/// Focal lengths and centre in px, k1 as in lens.hpp.
struct PerspectiveCamera {
  double fx{0}, fy{0}, cx{0}, cy{0};
  double k1_per_mm2{0};
};

/// Standard deviations of the hand's poses per axis; zero: taken to be exact.
struct HandNoise {
  double rotation_rad{0};
  double translation_mm{0};
};

struct RefinedCalibration {
  Pose object_from_hand{Pose::Identity()};  ///< Y, mm
  Pose hand_from_eye{Pose::Identity()};     ///< X^-1, mm
  PerspectiveCamera camera;
  double reprojection_px{0};  ///< rms per axis, hand poses as estimated
  double image_noise_px{0};   ///< standard deviation per axis, from the residuals
  HandNoise hand_noise;       ///< from the residuals; zero unless the images contradict the hand
};

/// Standard deviations: of rotations and translations the square root of the trace.
struct PerspectiveSigma {
  double object_from_hand_deg{0}, object_from_hand_mm{0};
  double hand_from_eye_deg{0}, hand_from_eye_mm{0};
  PerspectiveCamera camera;
};

struct Refinement {
  RefinedCalibration calibration;
  PerspectiveSigma sigma;
  std::vector<double> errors_px;  ///< every point's distance from where it is seen, in order
};

/// Whether every point is in front of the camera and on its lens, so that refine() can begin there.
bool can_begin(const Observations& observations, const RefinedCalibration& start,
               bool distortion_inside);

/// From a start that is near. The hand's poses are taken to be exact, unless the images contradict
/// them by more than the image noise explains: then they are weighted with noise of their own,
/// estimated with the rest, as a tracker's poses want it. Nothing when the data do not determine
/// every unknown.
std::optional<Refinement> refine(const Observations& observations, const RefinedCalibration& start,
                                 bool distortion_inside);

}  // namespace handeye
