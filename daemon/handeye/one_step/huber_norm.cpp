// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/huber_norm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace handeye {
namespace {

constexpr std::size_t kSteps = 1200;
constexpr double kStep = 0.01;  // of the norm: beyond 12 there is nothing to be counted

/// The density of the norm (chi), by the midpoints of a grid; sums to one.
std::array<double, kSteps> density_of_norm(int dimensions) {
  std::array<double, kSteps> density{};
  double sum = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double norm = (static_cast<double>(i) + 0.5) * kStep;
    density[i] = std::pow(norm, dimensions - 1) * std::exp(-0.5 * norm * norm);
    sum += density[i];
  }
  for (double& value : density) value /= sum;
  return density;
}

}  // namespace

HuberNorm huber_norm(int dimensions, double sigmas) {
  const std::array<double, kSteps> density = density_of_norm(dimensions);
  const double beyond = std::erfc(sigmas / std::sqrt(2.0));
  double tail = 0;
  std::size_t first = kSteps;
  while (first > 1 && tail + density[first - 1] < beyond) tail += density[--first];
  // Within the step that the tail ends in, in proportion.
  const double norm =
      (static_cast<double>(first) - (beyond - tail) / std::max(density[first - 1], 1e-300)) * kStep;
  double squares = 0;
  double weighted = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double at = (static_cast<double>(i) + 0.5) * kStep;
    squares += density[i] * at * at;
    weighted += density[i] * at * std::min(at, norm);
  }
  return {norm, weighted / squares};
}

double median_of_squares(int dimensions) {
  const std::array<double, kSteps> density = density_of_norm(dimensions);
  double below = 0;
  std::size_t i = 0;
  while (i < kSteps && below + density[i] < 0.5) below += density[i++];
  const double median = (static_cast<double>(i) + (0.5 - below) / density[i]) * kStep;
  return median * median;
}

}  // namespace handeye
