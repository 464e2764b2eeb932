// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/instrument.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/simulator/lattice_noise.hpp"

namespace handeye::simulator {
namespace {

/// At 480 px image height; each either way from its middle.
constexpr double kRadiusPx = 92.0;
constexpr double kSlidePx = 90.0;
constexpr double kSidewaysPx = 60.0;
constexpr double kSwing_rad = 0.25;
constexpr double kRoll_rad = 0.8;
constexpr double kApproach = 0.14;
constexpr double kEntrySpread_rad = 0.3;

constexpr float kTipRadii = 0.5F;  ///< how long the rounded tip is
constexpr float kRimPx = 1.5F;     ///< over which it covers half

constexpr int kTexels = 256;
constexpr float kTexelsPerRadius = 48.0F;

/// Radiances: of the metal in full light, and of its shine.
constexpr float kMetal = 0.55F;
constexpr float kShine = 6.0F;

/// From the left or from the right, a little upwards or downwards.
double draw_entry(RandomStream& random) {
  const bool from_left = random.uniform(0, 1) < 0.5;
  const double spread_rad = random.uniform(-kEntrySpread_rad, kEntrySpread_rad);
  return from_left ? spread_rad : kPi + spread_rad;
}

/// How far inside the outline, in radii; negative outside.
float inside(float back, float across) {
  if (back >= 0) return 1.0F - std::abs(across);
  return 1.0F - std::hypot(back / kTipRadii, across);
}

}  // namespace

Instrument::Instrument(int width, int height, std::uint64_t seed)
    : Instrument(width, height, RandomStream(seed, Purpose::kInstrument)) {}

Instrument::Instrument(int width, int height, RandomStream random)
    : width_(width),
      height_(height),
      entry_rad_(draw_entry(random)),
      swing_(random),
      slide_(random),
      sideways_(random),
      approach_(random),
      roll_(random),
      texture_(fractal_noise({16, 128, 0.8}, kTexels, random)) {}

Instrument::Place Instrument::place(double time_s) const {
  const double scale = height_ / 480.0;
  const double size = 1.0 + kApproach * approach_.at(time_s);
  const double direction_rad = entry_rad_ + kSwing_rad * swing_.at(time_s);
  const Eigen::Vector2d forwards(std::cos(direction_rad), std::sin(direction_rad));
  const Eigen::Vector2d middle(0.5 * (width_ - 1), 0.5 * (height_ - 1));
  const Eigen::Vector2d tip =
      middle + scale * (kSlidePx * slide_.at(time_s) * forwards +
                        kSidewaysPx * sideways_.at(time_s) * Eigen::Vector2d::UnitY());
  return {.tip = tip.cast<float>(),
          .backwards = -forwards.cast<float>(),
          .radius = static_cast<float>(scale * size * kRadiusPx),
          .roll_rad = static_cast<float>(kRoll_rad * roll_.at(time_s))};
}

float Instrument::texture(float back, float around) const {
  constexpr int kMask = kTexels - 1;
  const float u = back * kTexelsPerRadius;
  const float v = around * kTexelsPerRadius;
  const float left = std::floor(u);
  const float top = std::floor(v);
  const int column = static_cast<int>(left);
  const int row = static_cast<int>(top);
  const auto at = [this](int r, int c) { return texture_(r & kMask, c & kMask); };
  const float above = std::lerp(at(row, column), at(row, column + 1), u - left);
  const float below = std::lerp(at(row + 1, column), at(row + 1, column + 1), u - left);
  return std::lerp(above, below, v - top);
}

float Instrument::light(const Place& place, const Spot& spot) const {
  // A cylinder lit from the eye: bright along its middle, where it also mirrors the lamp.
  const float across = std::clamp(spot.across, -1.0F, 1.0F);
  const float facing = std::sqrt(1.0F - across * across);
  const float scratches = texture(spot.back, std::asin(across) + place.roll_rad);
  const float metal = kMetal * (0.25F + 0.75F * facing) * (1.0F + 0.3F * scratches);
  const float miss = (across - 0.1F + 0.05F * scratches) / 0.06F;
  const float shine = kShine * std::exp(-miss * miss) * std::clamp(scratches, 0.0F, 1.0F);
  return std::max(metal, 0.02F) + shine;
}

void Instrument::draw(double time_s, cv::Mat1f& radiance, cv::Mat1f& depth_mm) const {
  const Place place = this->place(time_s);
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const Eigen::Vector2f from_tip =
          Eigen::Vector2f(static_cast<float>(column), static_cast<float>(row)) - place.tip;
      const Spot spot{
          from_tip.dot(place.backwards) / place.radius,
          (place.backwards.x() * from_tip.y() - place.backwards.y() * from_tip.x()) / place.radius};
      const float rim_px = inside(spot.back, spot.across) * place.radius;
      if (rim_px <= 0) continue;
      const float covers = std::min(rim_px / kRimPx, 1.0F);
      float& seen = radiance(row, column);
      seen += covers * (light(place, spot) - seen);
      depth_mm(row, column) = 0;
    }
  }
}

}  // namespace handeye::simulator
