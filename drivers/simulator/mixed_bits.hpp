// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye::simulator {

/// Well mixed bits of two numbers (the finaliser of splitmix64): a random number that depends on
/// nothing but its place, so frames may be made in any order.
constexpr std::uint64_t mixed_bits(std::uint64_t a, std::uint64_t b) {
  std::uint64_t bits = a + 0x9e3779b97f4a7c15ULL * (b + 1);
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

/// The same as a number in [0, 1).
constexpr double mixed_fraction(std::uint64_t a, std::uint64_t b) {
  return static_cast<double>(mixed_bits(a, b) >> 11) * 0x1.0p-53;
}

}  // namespace handeye::simulator
