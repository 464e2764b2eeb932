// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/translation_weights.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

constexpr double kExact = 1e-9;        // residuals below are rounding: of rad and of the unit
constexpr double kMostOfLever = 0.98;  // of the translations' residual is put down to rotation
// Noise of variance v an axis in each of four poses turns a movement's E X against X H by 12 v in
// the mean square, and moves the end of its t by 2 v |t|^2.
constexpr double kLeverSquares = 2.0 / 12.0;
constexpr double kRowBalance = 0.5;  // best of 1/4, 1/2 and 1 in trials; little depends on it
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
  std::vector<double> weights(movements.size(), 1.0);
  if (std::max(rotation_squares, translation_squares) < kExact * kExact) return weights;

  const double per_lever = kLeverSquares * rotation_squares;
  const double without_lever = translation_squares - std::min(per_lever * mean_lever_squares,
                                                              kMostOfLever * translation_squares);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    const double variance = without_lever + per_lever * lever_squares(movements[k]);
    const double weight = std::sqrt(rotation_squares / (kRowBalance * variance));
    weights[k] = std::clamp(weight, 1.0 / kLargestWeight, kLargestWeight);
  }
  return weights;
}

}  // namespace handeye
