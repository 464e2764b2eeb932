// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/translation_weights.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

constexpr double kExact = 1e-9;        // residuals below are rounding: of rad and of the unit
constexpr double kMostOfLever = 0.98;  // of the translations' residual is put down to rotation
constexpr double kLeverSquares = 1.0 / 6.0;  // |w x t|^2 of two of four poses' noise to |w|^2 |t|^2
constexpr double kRowBalance = 0.5;          // found by experiment between 1/4 and 1, flat there
constexpr double kLargestWeight = 30;

double lever_squares(const Movement& movement) {
  return movement.hand_j_from_hand_i.translation().squaredNorm() +
         movement.eye_j_from_eye_i.translation().squaredNorm();
}

}  // namespace

std::vector<double> translation_weights(std::span<const Movement> movements,
                                        const Pose& eye_from_hand) {
  double rotation_squares = 0;
  double translation_squares = 0;
  double mean_lever_squares = 0;
  for (const Movement& movement : movements) {
    const auto& [hand, eye] = movement;
    const Pose by_hand = eye_from_hand * hand;
    const Pose by_eye = eye * eye_from_hand;
    const double angle = rotation_angle_rad(by_hand.linear(), by_eye.linear());
    rotation_squares += angle * angle;
    translation_squares += (by_hand.translation() - by_eye.translation()).squaredNorm();
    mean_lever_squares += lever_squares(movement);
  }
  const auto n = static_cast<double>(movements.size());
  rotation_squares /= n;
  translation_squares /= n;
  mean_lever_squares /= n;
  if (std::max(rotation_squares, translation_squares) < kExact * kExact) {
    return std::vector<double>(movements.size(), 1.0);
  }

  const double per_lever = kLeverSquares * rotation_squares;
  const double without_lever = translation_squares - std::min(per_lever * mean_lever_squares,
                                                              kMostOfLever * translation_squares);
  std::vector<double> weights;
  weights.reserve(movements.size());
  for (const Movement& movement : movements) {
    const double variance = without_lever + per_lever * lever_squares(movement);
    const double weight = std::sqrt(rotation_squares / (kRowBalance * variance));
    weights.push_back(std::clamp(weight, 1.0 / kLargestWeight, kLargestWeight));
  }
  return weights;
}

}  // namespace handeye
