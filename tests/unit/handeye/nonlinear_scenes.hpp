// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "daemon/handeye/types.hpp"

/// Random movements for the tests of the non-linear methods.
namespace handeye::synthetic {

class Random {
 public:
  explicit Random(std::uint32_t seed) : generator_(seed) {}
  double uniform(double from, double to);
  double power_of_ten(double from, double to);  ///< exponent uniform between
  double normal();
  Eigen::Vector3d normal3();
  Eigen::Quaterniond quaternion();  ///< of any norm

 private:
  std::mt19937 generator_;
};

/// Any rotation; a translation of about length_mm.
HandEyeSolution random_solution(Random& random, double length_mm, double scale_units_per_mm);

/// An exact movement about a random axis, hand translation of about length_mm.
Movement exact_movement(const HandEyeSolution& truth, Random& random, double angle_rad,
                        double length_mm);

/// 4 to 23 exact movements. Of three successive trials one turns by half a turn, give or take
/// 1e-6 to 0.1 rad, one so every other time, one by up to half a turn; all about random axes.
std::vector<Movement> random_movements(const HandEyeSolution& truth, Random& random, int trial);

/// Condition number of eq 6's matrix at the truth, columns of length 1.
double condition_of(const std::vector<Movement>& movements, const HandEyeSolution& truth);

/// Selected from 150 poses of the scope in a free hand, noise of tracker and camera.
std::vector<Movement> noisy_movements(double scale_units_per_mm, std::uint32_t seed);

}  // namespace handeye::synthetic
