// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye {

/// Frames missing between two that follow each other, by the device's own count modulo 2^32. 0 when
/// the count repeats (some drivers do) or goes back (the device has started anew).
constexpr std::uint32_t sequence_gap(std::uint32_t previous, std::uint32_t current) {
  const std::uint32_t step = current - previous;
  constexpr std::uint32_t kHalfTheRange = 0x8000'0000U;
  return step == 0 || step >= kHalfTheRange ? 0 : step - 1;
}

}  // namespace handeye
