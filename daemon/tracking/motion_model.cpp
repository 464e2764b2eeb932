// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/motion_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace handeye {
namespace {

constexpr int kFewest = 8;
constexpr int kRounds = 6;
constexpr double kLeastSpread = 0.3;  ///< px: nearer than that, all agree

}  // namespace

void MotionModel::fit(const std::vector<Eigen::Vector2f>& from,
                      const std::vector<Eigen::Vector2f>& to,
                      const std::vector<std::uint8_t>& usable) {
  forget();
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (usable[i] == 0) continue;
    middle += from[i].cast<double>();
    ++count;
  }
  if (count < kFewest) return;
  middle /= count;

  // Movement = parameters^T (1, x, y), about the middle and in hundreds of px.
  constexpr double kUnit = 100.0;
  Eigen::Matrix<double, 3, 2> parameters = Eigen::Matrix<double, 3, 2>::Zero();
  double spread = 1e3;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d normal = 1e-6 * Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    double weighted_squares = 0;
    double weights = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (usable[i] == 0) continue;
      Eigen::Vector3d row;
      row << 1.0, (from[i].cast<double>() - middle) / kUnit;
      const Eigen::Vector2d movement = (to[i] - from[i]).cast<double>();
      const double squared = (movement - parameters.transpose() * row).squaredNorm();
      const double weight = 1.0 / (1.0 + squared / (spread * spread));
      normal += weight * row * row.transpose();
      right += weight * row * movement.transpose();
      weighted_squares += weight * weight * squared;
      weights += weight * weight;
    }
    parameters = normal.ldlt().solve(right);
    spread = round == 0 ? 20.0 : std::max(std::sqrt(weighted_squares / weights), kLeastSpread);
  }
  known_ = true;
  middle_ = middle.cast<float>();
  shift_ = parameters.row(0).transpose().cast<float>();
  growth_ = (parameters.bottomRows<2>().transpose() / kUnit).cast<float>();
  spread_px_ = static_cast<float>(spread);
}

}  // namespace handeye
