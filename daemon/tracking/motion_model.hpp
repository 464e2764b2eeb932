// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace handeye {

/// How the image as a whole moved from one frame to the next: the affine map that most features
/// agree with. Says where to look for a feature that has no movement of its own to go by, and how
/// patches turn and grow meanwhile.
class MotionModel {
 public:
  /// Fits to + 0 where `usable[i]`; least squares with Cauchy's weights. Too few: no movement.
  void fit(const std::vector<Eigen::Vector2f>& from, const std::vector<Eigen::Vector2f>& to,
           const std::vector<std::uint8_t>& usable);
  void forget() { *this = {}; }

  bool known() const { return known_; }
  Eigen::Vector2f moved(const Eigen::Vector2f& from) const {
    return from + shift_ + growth_ * (from - middle_);
  }
  /// What a small patch undergoes.
  Eigen::Matrix2f linear() const { return Eigen::Matrix2f::Identity() + growth_; }
  /// Features stray from the model by about so much [px]: the scene is not flat.
  float spread_px() const { return spread_px_; }

 private:
  bool known_{false};
  Eigen::Vector2f middle_{Eigen::Vector2f::Zero()};
  Eigen::Vector2f shift_{Eigen::Vector2f::Zero()};
  Eigen::Matrix2f growth_{Eigen::Matrix2f::Zero()};
  float spread_px_{0};
};

}  // namespace handeye
