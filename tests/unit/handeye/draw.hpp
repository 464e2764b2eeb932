// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace handeye::synthetic {

/// Random numbers of one seed: the values within a configuration whose shape RapidCheck draws,
/// since that it can shrink.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : generator_(seed) {}
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(generator_);
  }
  double power_of_ten(double from, double to) { return std::pow(10.0, uniform(from, to)); }
  Eigen::Vector3d normal3() {
    const double x = normal_(generator_);
    const double y = normal_(generator_);
    return {x, y, normal_(generator_)};
  }
  Eigen::Vector3d direction() { return normal3().normalized(); }

 private:
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

}  // namespace handeye::synthetic
