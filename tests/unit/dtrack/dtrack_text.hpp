// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "drivers/dtrack/parser.hpp"

/// Texts that several tests put datagrams together from.
namespace handeye::dtrack {

inline const std::string kMatrix =
    "[0.664463 0.491450 0.562997 -0.664463 0.733295 0.144110 -0.342020 -0.469846 0.813798]";
inline const std::string kZeroMatrix =
    "[0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000]";
inline const std::string kPositionAndAngles = "[412.507 -88.250 1503.125 30.0000 -20.0000 45.0000]";

/// One target of a 6d line.
inline std::string body(std::string_view id, std::string_view quality = "1.000") {
  return "[" + std::string(id) + " " + std::string(quality) + "]" + kPositionAndAngles + kMatrix;
}

/// `fr 1` and these lines, each ended by CR LF.
inline std::string datagram(std::initializer_list<std::string> lines) {
  std::string text = "fr 1\r\n";
  for (const std::string& line : lines) text += line + "\r\n";
  return text;
}

/// A file of tests/data/dtrack.
inline std::string sample(const std::string& file) {
  std::ifstream stream(DTRACK_SAMPLES "/" + file, std::ios::binary);
  if (!stream) throw std::runtime_error("no sample " + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A fresh parser's view of one datagram.
struct Parsed {
  explicit Parsed(std::string_view text) { status = parser.parse(text, frame); }
  explicit Parsed(std::initializer_list<std::string> lines) : Parsed(datagram(lines)) {}

  const ParseCounters& counters() const { return parser.counters(); }

  Parser parser;
  Frame frame;
  ParseStatus status;
};

}  // namespace handeye::dtrack
