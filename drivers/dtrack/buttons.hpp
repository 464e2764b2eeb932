// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "drivers/dtrack/scanner.hpp"

/// Buttons come as decimal words of 32, bit 0 first.
namespace handeye::dtrack {

inline constexpr std::int32_t kButtonsPerWord = 32;

inline bool read_button_word(Scanner& line, std::uint32_t& word) {
  return line.read(word, 0, std::numeric_limits<std::uint32_t>::max());
}

/// Appends the lowest `count` (0..32) bits of a word.
inline void append_buttons(std::uint32_t word, std::int32_t count, std::vector<bool>& buttons) {
  for (std::int32_t bit = 0; bit < count; ++bit) buttons.push_back((word >> bit & 1U) != 0);
}

/// Reads as many words as `count` buttons need and appends the buttons.
inline bool read_buttons(Scanner& line, std::int32_t count, std::vector<bool>& buttons) {
  for (std::int32_t left = count; left > 0; left -= kButtonsPerWord) {
    std::uint32_t word = 0;
    if (!read_button_word(line, word)) return false;
    append_buttons(word, std::min(left, kButtonsPerWord), buttons);
  }
  return true;
}

}  // namespace handeye::dtrack
