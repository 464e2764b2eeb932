// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {
namespace {

constexpr int kPairs = 1000;
constexpr std::uint32_t kSeed = 20050601;
constexpr double kMinAngle_deg = 1.0;  // relative figures leave out pairs that turn by less
constexpr double kMinMovement = 0.01;  // or move by less than this share of the largest movement

/// Index below n. The standard's distributions differ between libraries; this one does not.
std::size_t below(std::mt19937& generator, std::size_t n) {
  return static_cast<std::size_t>((static_cast<std::uint64_t>(generator()) * n) >> 32U);
}

std::vector<Movement> random_movements(std::span<const PosePair> poses) {
  std::mt19937 generator(kSeed);
  std::vector<Movement> movements;
  movements.reserve(kPairs);
  for (int k = 0; k < kPairs; ++k) {
    const std::size_t i = below(generator, poses.size());
    const std::size_t j = (i + 1 + below(generator, poses.size() - 1)) % poses.size();
    movements.push_back(movement_between(poses[i], poses[j]));
  }
  return movements;
}

/// Mean of what was added; 0 of nothing.
struct Mean {
  double sum{0};
  double n{0};
  void add(double value) {
    sum += value;
    n += 1;
  }
  double value() const { return n > 0 ? sum / n : 0.0; }
};

}  // namespace

Residuals seed_residuals(std::span<const PosePair> poses, const HandEyeSolution& solution) {
  if (poses.size() < 2) return {};
  const std::vector<Movement> movements = random_movements(poses);
  double largest = 0;
  for (const Movement& movement : movements) {
    largest = std::max(largest, movement.eye_j_from_eye_i.translation().norm());
  }

  const Pose eye_from_hand = solution.hand_from_eye.inverse();
  Mean angle_deg, angle_percent, translation_percent, norm_percent;
  for (const auto& [hand, eye] : movements) {
    Pose predicted = eye_from_hand * hand * solution.hand_from_eye;  // E' = X H X^-1
    predicted.translation() *= solution.scale_units_per_mm;
    const double error_deg = deg_from_rad(rotation_angle_rad(eye.linear(), predicted.linear()));
    const double turn_deg = deg_from_rad(rotation_angle_rad(eye.linear()));
    const double length = eye.translation().norm();
    angle_deg.add(error_deg);
    if (turn_deg < kMinAngle_deg || !(length > 0) || length < kMinMovement * largest) continue;
    const double error = (eye.translation() - predicted.translation()).norm();
    angle_percent.add(100.0 * error_deg / turn_deg);
    translation_percent.add(100.0 * error / length);
    norm_percent.add(100.0 * std::abs(length - predicted.translation().norm()) / length);
  }
  return {angle_deg.value(), angle_percent.value(), translation_percent.value(),
          norm_percent.value()};
}

}  // namespace handeye
