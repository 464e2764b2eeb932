// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/line_splitter.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace handeye::dtrack {
namespace {

std::vector<std::string> lines_of(std::string_view datagram) {
  std::vector<std::string> lines;
  std::string_view line;
  for (LineSplitter splitter(datagram); splitter.next(line);) lines.emplace_back(line);
  return lines;
}

using Lines = std::vector<std::string>;

TEST(DTrackLineSplitter, AnyLineEnd) {
  EXPECT_EQ(lines_of("a\r\nb\r\n"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of("a\nb\n"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of("a\rb\r"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of("a\r\nb\nc\rd\n\re"), (Lines{"a", "b", "c", "d", "e"}));
}

TEST(DTrackLineSplitter, BlankLinesAndMissingEnd) {
  EXPECT_EQ(lines_of(""), Lines{});
  EXPECT_EQ(lines_of("\r\n\r\n\n\r"), Lines{});
  EXPECT_EQ(lines_of("\r\n\na\r\n\r\nb"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of(" \r\n"), Lines{" "});
}

}  // namespace
}  // namespace handeye::dtrack
