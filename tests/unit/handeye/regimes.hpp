// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tests/unit/handeye/synthetic.hpp"

namespace handeye::synthetic {

/// A regime of noise and motion: camera poses at random about a target, hand a lever arm away.
struct Regime {
  std::string_view name;
  int poses;
  double turn_deg;      ///< uniform within +- this about each axis
  double shift_mm;      ///< the camera's centre, likewise
  double lever_arm_mm;  ///< length of hand_from_eye's translation
  PoseNoise noise;
};

/// The regimes in which methods are compared.
std::span<const Regime> regimes();

/// One sample, the same for the same seed; exact poses beside those with noise.
struct RegimeSample {
  Truth truth;
  std::vector<Pose> room_from_hand;  ///< without noise
  std::vector<PosePair> poses;       ///< with noise
};
RegimeSample sample(const Regime& regime, std::uint32_t seed, double scale_units_per_mm);

/// Root mean square of errors.
class RmsError {
 public:
  void add(const Vector6d& error);
  double rotation_deg() const;
  double translation_mm() const;

 private:
  double rotation_square_{0};
  double translation_square_{0};
  int count_{0};
};

}  // namespace handeye::synthetic
