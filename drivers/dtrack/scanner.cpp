// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/scanner.hpp"

#include <array>
#include <cstddef>
#include <cstdlib>

namespace handeye::dtrack {
namespace {

/// Integers of up to 15 digits are exact as doubles, as are these powers; then one IEEE
/// multiplication or division rounds correctly (Clinger, "How to read floating point numbers
/// accurately", 1990).
constexpr std::array kPowersOfTen = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
constexpr std::ptrdiff_t kExactDigits = 15;

/// 0..9, or above 9 for anything but a digit.
constexpr unsigned digit(char character) {
  return static_cast<unsigned>(static_cast<unsigned char>(character)) - unsigned{'0'};
}

}  // namespace

bool Scanner::open_block() {
  if (!at_block()) {
    return fail(at_ == end_ ? ErrorKind::kMissingTarget : ErrorKind::kTrailingText);
  }
  ++at_;
  in_block_ = true;
  return true;
}

bool Scanner::close_block() {
  while (at_ != end_ && *at_ != ']') {
    if (*at_ == '[') return fail(ErrorKind::kUnclosedBlock);
    ++at_;
  }
  if (at_ == end_) return fail(ErrorKind::kUnclosedBlock);
  ++at_;
  in_block_ = false;
  return true;
}

bool Scanner::read(double& value) {
  if (!start_value()) return false;
  const char* at = at_;
  const bool negative = *at == '-';
  if (negative) ++at;
  const char* const first = at;
  std::uint64_t digits = 0;
  for (; at != end_ && digit(*at) < 10; ++at) digits = digits * 10 + digit(*at);
  std::ptrdiff_t digit_count = at - first;
  std::ptrdiff_t decimals = 0;
  if (at != end_ && *at == '.') {
    const char* const point = at++;
    for (; at != end_ && digit(*at) < 10; ++at) digits = digits * 10 + digit(*at);
    decimals = at - point - 1;
    digit_count += decimals;
  }
  std::int32_t power_of_ten = 0;
  if (at != end_ && (*at == 'e' || *at == 'E')) {
    ++at;
    if (end_ - at > 1 && at[0] == '+' && digit(at[1]) < 10) ++at;
    const auto [behind, problem] = std::from_chars(at, end_, power_of_ten);
    if (problem != std::errc{}) return read_any_precision(value);
    at = behind;
  }
  const std::ptrdiff_t scale = power_of_ten - decimals;
  if (digit_count == 0 || digit_count > kExactDigits || std::abs(scale) > kExactDigits) {
    return read_any_precision(value);
  }
  const double power = kPowersOfTen[static_cast<std::size_t>(std::abs(scale))];
  const auto whole = static_cast<double>(digits);
  const double magnitude = scale < 0 ? whole / power : whole * power;
  value = negative ? -magnitude : magnitude;
  at_ = at;
  return end_value();
}

bool Scanner::read(std::span<double> values) {
  for (double& value : values) {
    if (!read(value)) return false;
  }
  return true;
}

bool Scanner::read_any_precision(double& value) {
  const char* const first = *at_ == '-' ? at_ + 1 : at_;
  // from_chars would take "nan" and "inf".
  if (first == end_ || (digit(*first) > 9 && *first != '.')) return fail(ErrorKind::kBadNumber);
  const auto [behind, problem] = std::from_chars(at_, end_, value);
  if (problem == std::errc::result_out_of_range) return fail(ErrorKind::kNumberOutOfRange);
  if (problem != std::errc{}) return fail(ErrorKind::kBadNumber);
  at_ = behind;
  return end_value();
}

}  // namespace handeye::dtrack
