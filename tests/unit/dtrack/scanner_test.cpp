// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/scanner.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <locale>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

double standard_reading(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(error, std::errc{}) << text;
  EXPECT_EQ(end, text.data() + text.size()) << text;
  return value;
}

void expect_same_bits_as_standard(const std::string& text) {
  double value = 0;
  Scanner scanner(text);
  ASSERT_TRUE(scanner.read(value)) << text << ": " << name(scanner.error());
  EXPECT_EQ(std::bit_cast<std::uint64_t>(value),
            std::bit_cast<std::uint64_t>(standard_reading(text)))
      << text;
}

TEST(DTrackScanner, NumbersAreReadToTheLastBit) {
  for (const std::string text : {"0",
                                 "-0.000000",
                                 "1.000",
                                 "412.507",
                                 "-0.342020",
                                 "43200.500000",
                                 "8.178e-04",
                                 "1E5",
                                 "7e-15",
                                 "-3.25E+12",
                                 "1e15",
                                 "1e+22",
                                 "1e-22",
                                 "123456789012345",
                                 "1234567890123456",
                                 "0.1234567890123456789",
                                 "1.e3",
                                 "9007199254740993",
                                 "2.2250738585072014e-308",
                                 "1.7976931348623157e308",
                                 ".5",
                                 "5.",
                                 "0.000000000000000000000000000001",
                                 "-1e-5",
                                 "00012.50"}) {
    expect_same_bits_as_standard(text);
  }
}

TEST(DTrackScanner, RandomNumbersAreReadToTheLastBit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-12, 12);
  std::array<char, 64> text;
  for (int i = 0; i < 100'000; ++i) {
    const double value = std::pow(10.0, exponent(random)) * (random() % 2 == 0 ? 1 : -1);
    const char* const format = i % 2 == 0 ? "%.*f" : "%.*e";
    const int decimals = static_cast<int>(random() % 12);
    std::snprintf(text.data(), text.size(), format, decimals, value);
    expect_same_bits_as_standard(text.data());
  }
}

TEST(DTrackScanner, ValuesBlocksAndBlanks) {
  Scanner scanner(" 3  [1 2.5  -3]   [ 7 ][] ");
  std::int32_t count = 0;
  std::array<double, 3> values{};
  EXPECT_TRUE(scanner.read_count(count));
  EXPECT_EQ(count, 3);
  EXPECT_TRUE(scanner.read_block(values));
  EXPECT_EQ(values, (std::array<double, 3>{1, 2.5, -3}));
  EXPECT_TRUE(scanner.open_block() && scanner.read(count, -9, 9) && scanner.close_block());
  EXPECT_EQ(count, 7);
  EXPECT_TRUE(scanner.at_block());
  EXPECT_TRUE(scanner.open_block() && scanner.close_block());
  EXPECT_TRUE(scanner.finish());
}

TEST(DTrackScanner, IntegersOutsideTheirRange) {
  const auto error_of = [](std::string_view text) {
    std::int32_t value = 0;
    Scanner scanner(text);
    EXPECT_FALSE(scanner.read(value, -5, 5)) << text;
    return scanner.error();
  };
  EXPECT_EQ(error_of("6"), ErrorKind::kNumberOutOfRange);
  EXPECT_EQ(error_of("-6"), ErrorKind::kNumberOutOfRange);
  EXPECT_EQ(error_of("99999999999999999999"), ErrorKind::kNumberOutOfRange);
  EXPECT_EQ(error_of("1.5"), ErrorKind::kBadNumber);
  EXPECT_EQ(error_of("x"), ErrorKind::kBadNumber);
  EXPECT_EQ(error_of("0x3"), ErrorKind::kBadNumber);
  EXPECT_EQ(error_of(""), ErrorKind::kMissingValue);
}

/// A locale whose decimal point is a comma, as de_DE has, without asking for an installed one.
struct CommaPoint : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(DTrackScanner, NumbersDoNotDependOnTheLocale) {
  const std::string c_locale_before = std::setlocale(LC_ALL, nullptr);
  const std::locale before = std::locale::global(std::locale(std::locale(), new CommaPoint));
  for (const char* german : {"de_DE.UTF-8", "de_DE.utf8", "de_DE"}) {
    if (std::setlocale(LC_ALL, german) != nullptr) break;  // else the C++ locale has to do
  }
  const Parsed parsed(sample("full_frame.txt"));
  const Parsed comma{"ts 43200,500000"};
  std::locale::global(before);
  std::setlocale(LC_ALL, c_locale_before.c_str());
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.frame.seconds_of_day, 43200.5);
  EXPECT_EQ(parsed.frame.markers.at(0).position_mm, Eigen::Vector3d(55.125, -310.75, 1210));
  EXPECT_FALSE(comma.frame.seconds_of_day.has_value());
}

}  // namespace
}  // namespace handeye::dtrack
