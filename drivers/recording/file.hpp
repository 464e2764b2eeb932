// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace handeye {

/// Opens a file for reading bytes. Throws InputError ("PATH: not there", "PATH: is a folder", ...).
std::ifstream open_for_reading(const std::filesystem::path& path);

/// The whole file. Throws InputError.
std::string read_whole_file(const std::filesystem::path& path);

/// The whole text as a number, with nothing before or behind it; nothing when it is not one.
template <typename Integer>
std::optional<Integer> parse_integer(std::string_view text) {
  Integer value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace handeye
