// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/session/calibration_watch_equations.hpp"
#include "tests/unit/session/watch_scene.hpp"

namespace handeye::test {

/// What can be known of a turned head at most: knows when it was turned, where hand, eye and points
/// truly are, which features slide and how large the noise is, and takes every frame. Its
/// information on hand_from_eye is Fisher's, from all frames since, with hand, points and place of
/// the head unknown (the Cramer-Rao bound). What was seen before the turn does not count: that the
/// picture moves while the hand rests, a scene that moves does as well.
class IdealWatch {
 public:
  explicit IdealWatch(const WatchedCalibration& calibration) : calibration_(calibration) {}

  /// After each frame since the head came to rest.
  void see(const WatchScene& scene);

  /// Whether chi2 of the deviation's rotation, three degrees of freedom, would on average pass what
  /// chance passes once in 10^6.
  bool fires() const { return chi2_ > kOnceInAMillion; }
  double chi2() const { return chi2_; }

 private:
  static constexpr double kOnceInAMillion = 30.7;  // as the watch itself

  Matrix6d information() const;

  WatchedCalibration calibration_;
  std::vector<WatchFrame> frames_;
  WatchUnknowns truth_;
  Matrix6d closed_{Matrix6d::Zero()};  ///< information of stretches of frames before these
  double chi2_{0};
};

}  // namespace handeye::test
