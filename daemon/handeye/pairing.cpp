// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/pairing.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

constexpr double kGoldenRatio = 0.6180339887498949;

/// How far apart paired elements are: one step of each stratum of 1..n/2, irregular within it lest
/// a periodic motion always meets itself.
std::vector<std::size_t> steps(std::size_t n, std::size_t partners) {
  const std::size_t half = n / 2;
  std::vector<std::size_t> result;
  if (n <= partners + 1) {
    for (std::size_t step = 1; step <= half; ++step) result.push_back(step);
    return result;
  }
  const std::size_t wanted = std::min(half, std::max<std::size_t>(1, partners / 2));
  const double stratum = static_cast<double>(half) / static_cast<double>(wanted);
  for (std::size_t m = 0; m < wanted; ++m) {
    const double within = std::fmod(static_cast<double>(m + 1) * kGoldenRatio, 1.0);
    const auto step = 1 + static_cast<std::size_t>(stratum * (static_cast<double>(m) + within));
    result.push_back(std::min(step, half));
  }
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

std::vector<std::array<std::size_t, 2>> spread_pairs(std::size_t n, std::size_t partners) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (const std::size_t step : steps(n, partners)) {
    const std::size_t starts = 2 * step == n ? step : n;  // half way round, k meets itself again
    for (std::size_t k = 0; k < starts; ++k) {
      const std::size_t other = (k + step) % n;
      pairs.push_back({std::min(k, other), std::max(k, other)});
    }
  }
  return pairs;
}

}  // namespace handeye
