// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/screw.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace handeye {
namespace {

// Noise of the translation by noise of the rotation, of a tracker and of a camera alike: beyond so
// long a lever the axis' error outweighs the translation's own.
constexpr double kNoiseLever_mm = 150;
// Below it differences are rounding, of nine printed digits at worst.
constexpr double kMinSigma = 1e-7;
constexpr std::size_t kMaxHypotheses = 100;  // for the scale
constexpr std::size_t kMaxScored = 600;      // movements that each of them is tried on
constexpr double kRadiusDifferences = 4;     // times their typical one is possible
constexpr double kAnglesPerSigma = 5;        // an axis is meant by angles of so many sigma

struct Side {
  double angle_rad{0};
  double pitch{0};
  double radius{0};
};

Side side_of(const Pose& movement) {
  const Eigen::Vector3d w = log_so3(movement.linear());
  const double angle = w.norm();
  if (!(angle > 0)) return {};
  const Eigen::Vector3d axis = w / angle;
  const double pitch = axis.dot(movement.translation());
  const double across = (movement.translation() - pitch * axis).norm();
  return {angle, pitch, across / (2.0 * std::sin(0.5 * angle))};
}

/// x with P(|normal| < x) = quantile, by Newton's method.
double normal_quantile(double quantile) {
  double x = 0.5;
  for (int i = 0; i < 20; ++i) {
    const double density = std::sqrt(2.0 / kPi) * std::exp(-0.5 * x * x);
    x -= (std::erf(x / std::sqrt(2.0)) - quantile) / density;
  }
  return x;
}

double quantile_of(std::vector<double>& values, double quantile) {
  const auto index = static_cast<std::ptrdiff_t>(quantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

/// Evenly, at most `most` of them.
std::vector<ScrewPair> thinned(std::span<const ScrewPair> pairs, std::size_t most) {
  std::vector<ScrewPair> kept;
  const std::size_t step = (pairs.size() + most - 1) / most;
  for (std::size_t k = 0; k < pairs.size(); k += step) kept.push_back(pairs[k]);
  return kept;
}

double chord(double angle_rad, double pitch, double radius) {
  return std::hypot(pitch, 2.0 * radius * std::sin(0.5 * angle_rad));
}

/// Ratio of the median lengths of the movements: right up to the effect of the lever arm.
double ratio_of_lengths(std::span<const ScrewPair> pairs) {
  std::vector<double> hand;
  std::vector<double> eye;
  for (const ScrewPair& p : pairs) {
    hand.push_back(chord(p.hand_angle_rad, p.hand_pitch_mm, p.hand_radius_mm));
    eye.push_back(chord(p.eye_angle_rad, p.eye_pitch, p.eye_radius));
  }
  const double ratio = quantile_of(hand, 0.5) / quantile_of(eye, 0.5);
  return std::isnormal(ratio) ? ratio : 1.0;
}

/// The scale whose differences of the pitches have the least quantile.
double best_mm_per_unit(std::span<const ScrewPair> pairs, ScrewAgreement agreement,
                        double quantile) {
  const std::vector<ScrewPair> scored = thinned(pairs, kMaxScored);
  std::vector<double> values;
  for (const ScrewPair& p : scored) values.push_back(std::abs(p.hand_pitch_mm));
  const double median_pitch_mm = quantile_of(values, 0.5);
  std::vector<ScrewPair> proposing;
  for (const ScrewPair& p : scored) {
    if (std::abs(p.hand_pitch_mm) >= median_pitch_mm) proposing.push_back(p);
  }
  double best = agreement.reference_mm_per_unit;
  double least = -1;
  for (const ScrewPair& p : thinned(proposing, kMaxHypotheses)) {
    agreement.mm_per_unit = p.hand_pitch_mm / p.eye_pitch;
    if (!std::isnormal(agreement.mm_per_unit) || agreement.mm_per_unit < 0) continue;
    values.clear();
    for (const ScrewPair& other : scored) values.push_back(agreement.pitch_difference(other));
    const double score = quantile_of(values, quantile);
    if (least < 0 || score < least) {
      least = score;
      best = agreement.mm_per_unit;
    }
  }
  return best;
}

}  // namespace

ScrewPair screw_pair(const Movement& movement) {
  const Side hand = side_of(movement.hand_j_from_hand_i);
  const Side eye = side_of(movement.eye_j_from_eye_i);
  return {hand.angle_rad, eye.angle_rad, hand.pitch, eye.pitch, hand.radius, eye.radius};
}

double ScrewAgreement::pitch_difference(const ScrewPair& pair) const {
  const double eye_noise_lever_mm = kNoiseLever_mm * mm_per_unit / reference_mm_per_unit;
  const double eye_radius_mm =
      std::min(mm_per_unit * pair.eye_radius, pair.hand_radius_mm + radius_difference_mm);
  const double hand_radius_mm =
      std::min(pair.hand_radius_mm, mm_per_unit * pair.eye_radius + radius_difference_mm);
  const double lever_mm =
      std::sqrt(kNoiseLever_mm * kNoiseLever_mm + eye_noise_lever_mm * eye_noise_lever_mm +
                hand_radius_mm * hand_radius_mm + eye_radius_mm * eye_radius_mm);
  const double eye_mm = mm_per_unit * pair.eye_pitch;
  double difference_mm = std::abs(eye_mm - pair.hand_pitch_mm);
  const double short_of_half_a_turn = kPi - std::max(pair.hand_angle_rad, pair.eye_angle_rad);
  if (short_of_half_a_turn < kAnglesPerSigma * angle_sigma_rad) {
    difference_mm = std::min(difference_mm, std::abs(eye_mm + pair.hand_pitch_mm));
  }
  return difference_mm / lever_mm;
}

bool ScrewAgreement::can_judge(const ScrewPair& pair, double min_angle_rad) const {
  return std::max(pair.hand_angle_rad, pair.eye_angle_rad) >=
         std::max(min_angle_rad, kAnglesPerSigma * angle_sigma_rad);
}

bool ScrewAgreement::agrees(const ScrewPair& pair, double tolerance) const {
  return std::abs(pair.hand_angle_rad - pair.eye_angle_rad) <= tolerance * angle_sigma_rad &&
         pitch_difference(pair) <= tolerance * pitch_sigma;
}

std::optional<ScrewAgreement> screw_agreement(std::span<const ScrewPair> pairs, ScaleMode scale,
                                              double quantile) {
  if (pairs.empty()) return std::nullopt;
  const double per_sigma = normal_quantile(quantile);
  ScrewAgreement agreement;
  std::vector<double> values;
  for (const ScrewPair& p : pairs) values.push_back(std::abs(p.hand_angle_rad - p.eye_angle_rad));
  agreement.angle_sigma_rad = std::max(kMinSigma, quantile_of(values, quantile) / per_sigma);
  if (scale == ScaleMode::kUnknown) {
    agreement.reference_mm_per_unit = ratio_of_lengths(pairs);
    agreement.mm_per_unit = best_mm_per_unit(pairs, agreement, quantile);
  }
  values.clear();
  for (const ScrewPair& p : pairs) {
    values.push_back(std::abs(p.hand_radius_mm - agreement.mm_per_unit * p.eye_radius));
  }
  agreement.radius_difference_mm = kRadiusDifferences * quantile_of(values, quantile);
  values.clear();
  for (const ScrewPair& p : pairs) values.push_back(agreement.pitch_difference(p));
  agreement.pitch_sigma = std::max(kMinSigma, quantile_of(values, quantile) / per_sigma);
  return agreement;
}

}  // namespace handeye
