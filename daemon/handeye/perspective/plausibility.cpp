// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/plausibility.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

/// A hand that disagrees with its images by more than this, or by more than this part of its own
/// movement, is no noisy hand but a wrong one.
constexpr double kWrongHand_rad = 0.1;
constexpr double kWrongHandPart = 0.3;
/// What is known no better than this is not known.
constexpr double kUnknown_deg = 10.0;

/// Rms of the hand's translations.
double hand_movement_mm(const Observations& observations) {
  double sum = 0.0;
  for (const ObservedPosition& position : observations.positions) {
    sum += position.hand1_from_hand.translation().squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(observations.positions.size()));
}

/// What a translation must be known to: the object's distance from the camera, or less where hand
/// and camera have moved less.
double known_length_mm(const Observations& observations, const RefinedCalibration& calibration) {
  const Pose& hand_from_eye = calibration.hand_from_eye;
  const Pose eye1_from_object = (calibration.object_from_hand * hand_from_eye).inverse();
  double distance_mm = 0.0;
  for (const ObjectPoint& point : observations.positions.front().points) {
    distance_mm += (eye1_from_object * point.object_mm).norm();
  }
  distance_mm /= static_cast<double>(observations.positions.front().points.size());
  double eye_squares = 0.0;
  for (const ObservedPosition& position : observations.positions) {
    const Pose eye1_from_eye = hand_from_eye.inverse() * position.hand1_from_hand * hand_from_eye;
    eye_squares += eye1_from_eye.translation().squaredNorm();
  }
  const double eye_movement_mm =
      std::sqrt(eye_squares / static_cast<double>(observations.positions.size()));
  return std::min(distance_mm, std::max(hand_movement_mm(observations), eye_movement_mm));
}

}  // namespace

PerspectiveRefusal not_determined() {
  return {"uncertain",
          "the observations do not determine camera and hand-eye: use more positions, turned "
          "further about two axes, with points that fill the image"};
}

std::optional<PerspectiveRefusal> doubtful(const Observations& observations,
                                           const Refinement& refinement) {
  const HandNoise& noise = refinement.calibration.hand_noise;
  if (noise.rotation_rad > kWrongHand_rad ||
      noise.translation_mm > kWrongHandPart * hand_movement_mm(observations)) {
    return PerspectiveRefusal{"inconsistent",
                              "the images contradict the hand's poses: is hand1_from_hand given "
                              "(not its inverse), in mm, in the order of the images?"};
  }
  const PerspectiveSigma& sigma = refinement.sigma;
  const double limit_mm = known_length_mm(observations, refinement.calibration);
  const bool known = sigma.hand_from_eye_mm < limit_mm && sigma.object_from_hand_mm < limit_mm &&
                     sigma.hand_from_eye_deg < kUnknown_deg &&
                     sigma.object_from_hand_deg < kUnknown_deg &&
                     sigma.camera.fx < refinement.calibration.camera.fx;
  if (!known) return not_determined();
  return std::nullopt;
}

}  // namespace handeye
