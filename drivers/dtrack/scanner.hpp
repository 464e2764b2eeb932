// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>
#include <system_error>

#include "drivers/dtrack/limits.hpp"
#include "drivers/dtrack/parse_report.hpp"

namespace handeye::dtrack {

/// Reads the payload of one line: values separated by blanks, blocks in brackets. Never looks past
/// the line. Every read returns false at the first thing that is wrong and `error()` tells what;
/// what was read until then means nothing, the caller gives the line up.
class Scanner {
 public:
  explicit Scanner(std::string_view payload)
      : at_(payload.data()), end_(payload.data() + payload.size()) {}

  ErrorKind error() const { return error_; }

  /// Gives the line up for a reason the caller found. Always false.
  bool fail(ErrorKind error) {
    error_ = error;
    return false;
  }

  /// Enters the next block; blanks before it are allowed.
  bool open_block();

  /// Leaves the block; further values in it are ignored, for later versions may append some.
  bool close_block();

  /// True if another block follows.
  bool at_block() {
    skip_blanks();
    return at_ != end_ && *at_ == '[';
  }

  /// True if nothing but blanks is left.
  bool at_end() {
    skip_blanks();
    return at_ == end_;
  }

  /// Demands the end of the line.
  bool finish() { return at_end() || fail(ErrorKind::kTrailingText); }

  /// A finite decimal number, exponent allowed.
  bool read(double& value);

  /// As many numbers as there is room for.
  bool read(std::span<double> values);

  /// A whole block: at least as many numbers as there is room for.
  bool read_block(std::span<double> values) {
    return open_block() && read(values) && close_block();
  }

  /// An integer in [lowest, highest]; outside it the error is `otherwise`.
  template <std::integral Integer>
  bool read(Integer& value, std::type_identity_t<Integer> lowest,
            std::type_identity_t<Integer> highest,
            ErrorKind otherwise = ErrorKind::kNumberOutOfRange) {
    if (!start_value()) return false;
    const auto [behind, problem] = std::from_chars(at_, end_, value);
    if (problem == std::errc::invalid_argument) return fail(ErrorKind::kBadNumber);
    if (problem != std::errc{} || value < lowest || value > highest) return fail(otherwise);
    at_ = behind;
    return end_value();
  }

  bool read_id(std::int32_t& id, std::int32_t highest = kMaxId) {
    return read(id, 0, highest, ErrorKind::kBadId);
  }

  bool read_count(std::int32_t& count, std::int32_t highest = kMaxCount) {
    return read(count, 0, highest, ErrorKind::kBadCount);
  }

 private:
  void skip_blanks() {
    while (at_ != end_ && *at_ == ' ') ++at_;
  }

  /// Goes to the first character of the next value.
  bool start_value() {
    skip_blanks();
    if (at_ != end_ && *at_ != ']' && *at_ != '[') return true;
    return fail(in_block_ && (at_ == end_ || *at_ == '[') ? ErrorKind::kUnclosedBlock
                                                          : ErrorKind::kMissingValue);
  }

  /// A value must end where its digits end: "1,000" and "0x10" do not.
  bool end_value() {
    if (at_ == end_ || *at_ == ' ' || *at_ == ']') return true;
    return fail(*at_ == '[' ? ErrorKind::kUnclosedBlock : ErrorKind::kBadNumber);
  }

  bool read_any_precision(double& value);

  const char* at_;
  const char* end_;
  bool in_block_{false};
  ErrorKind error_{ErrorKind::kTrailingText};
};

}  // namespace handeye::dtrack
