// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace handeye {

/// Differing bits of two FeatureDescription::bits, 0 to 256: under about 60 for the same spot seen
/// again, about 128 for two that have nothing in common.
inline int hamming_distance(const std::array<std::uint8_t, 32>& a,
                            const std::array<std::uint8_t, 32>& b) {
  std::array<std::uint64_t, 4> left{};
  std::array<std::uint64_t, 4> right{};
  std::memcpy(left.data(), a.data(), a.size());
  std::memcpy(right.data(), b.data(), b.size());
  int distance = 0;
  for (std::size_t i = 0; i < left.size(); ++i) distance += std::popcount(left[i] ^ right[i]);
  return distance;
}

}  // namespace handeye
