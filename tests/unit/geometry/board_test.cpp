// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handeye {
namespace {

Board parsed(std::string_view text) {
  const auto result = parse_board(text);
  if (const auto* problem = std::get_if<std::string>(&result)) ADD_FAILURE() << *problem;
  return std::holds_alternative<Board>(result) ? std::get<Board>(result) : Board{};
}

std::string problem(std::string_view text) {
  const auto result = parse_board(text);
  const auto* words = std::get_if<std::string>(&result);
  return words ? *words : "accepted";
}

TEST(Board, IsReadFromItsName) {
  const Board chessboard = parsed("chessboard:9x6:23.6");
  EXPECT_EQ(chessboard.kind, Board::Kind::kChessboard);
  EXPECT_EQ(chessboard.columns, 9);
  EXPECT_EQ(chessboard.rows, 6);
  EXPECT_EQ(chessboard.square_mm, 23.6);
  const Board charuco = parsed("charuco:5x7:4:3:DICT_4X4_50");
  EXPECT_EQ(charuco.kind, Board::Kind::kCharuco);
  EXPECT_EQ(charuco.marker_mm, 3.0);
  EXPECT_EQ(charuco.dictionary, "DICT_4X4_50");
}

TEST(Board, IsWrittenAsItIsRead) {
  for (const char* text : {"chessboard:9x6:23.6", "charuco:5x7:4:3:DICT_APRILTAG_36H11"}) {
    EXPECT_EQ(to_string(parsed(text)), text);
  }
}

TEST(Board, HasItsCornersRowByRow) {
  const auto corners = parsed("chessboard:3x4:10").corners_mm();
  ASSERT_EQ(corners.size(), 12U);
  EXPECT_EQ(corners[1], Eigen::Vector3d(10, 0, 0));
  EXPECT_EQ(corners[3], Eigen::Vector3d(0, 10, 0));
  // A ChArUco board counts squares: one corner fewer each way.
  EXPECT_EQ(parsed("charuco:5x7:4:3:DICT_4X4_50").corners_mm().size(), 24U);
}

TEST(Board, SaysWhatIsWrongWithAName) {
  for (const char* text :
       {"", "chessboard", "chess:9x6:2", "chessboard:9x6:2:3", "charuco:9x6:2"}) {
    EXPECT_THAT(problem(text), testing::HasSubstr("must be chessboard:COLSxROWS:SQUARE_MM"))
        << text;
  }
  EXPECT_THAT(problem("chessboard:9:2"), testing::HasSubstr("COLSxROWS"));
  EXPECT_THAT(problem("chessboard:9x6.5:2"), testing::HasSubstr("COLSxROWS"));
  EXPECT_THAT(problem("chessboard:1x6:2"), testing::HasSubstr("inner corners"));
  EXPECT_THAT(problem("chessboard:9x6000:2"), testing::HasSubstr("inner corners"));
  for (const char* text : {"chessboard:9x6:0", "chessboard:9x6:nan", "chessboard:9x6:-2",
                           "chessboard:9x6:2mm", "chessboard:9x6:inf", "chessboard:9x6:0.009"}) {
    EXPECT_THAT(problem(text), testing::HasSubstr("SQUARE_MM")) << text;
  }
  EXPECT_THAT(problem("charuco:5x7:4:4:DICT_4X4_50"), testing::HasSubstr("MARKER_MM"));
  EXPECT_THAT(problem("charuco:5x7:4:1e-40:DICT_4X4_50"), testing::HasSubstr("MARKER_MM"));
  EXPECT_THAT(problem("charuco:5x7:4:3.9999999999:DICT_4X4_50"), testing::HasSubstr("MARKER_MM"));
  EXPECT_THAT(problem("charuco:5x7:4:3:DICT_9X9_1"), testing::HasSubstr("DICTIONARY"));
}

TEST(Board, HasCornersEnoughToBeFound) {
  const auto accepted = [](std::string_view text) {
    return std::holds_alternative<Board>(parse_board(text));
  };
  for (const char* text : {"chessboard:3x3:5", "chessboard:100x100:5",
                           "charuco:3x3:5:3:DICT_4X4_50", "chessboard:9x6:0.01"}) {
    EXPECT_TRUE(accepted(text)) << text;
  }
  for (const char* text : {"chessboard:2x6:5", "chessboard:6x2:5", "chessboard:-2147483648x6:5",
                           "charuco:2x6:5:3:DICT_4X4_50", "charuco:-2147483648x6:5:3:DICT_4X4_50",
                           "chessboard:101x6:5"}) {
    EXPECT_FALSE(accepted(text)) << text;
  }
}

TEST(Board, HasNoMoreMarkersThanItsDictionary) {
  EXPECT_THAT(problem("charuco:20x20:5:3:DICT_4X4_50"),
              testing::HasSubstr("needs 200 markers, DICT_4X4_50 has 50"));
  EXPECT_THAT(problem("charuco:11x10:5:3:DICT_4X4_50"), testing::HasSubstr("needs 55"));
  // 11 x 9 squares: 49 light ones.
  for (const char* text : {"charuco:10x10:5:3:DICT_4X4_50", "charuco:11x9:5:3:DICT_4X4_50"}) {
    EXPECT_TRUE(std::holds_alternative<Board>(parse_board(text))) << text;
  }
}

TEST(Board, IsEchoedShortAndInPrintableLetters) {
  const std::string nonsense = "chess\n\x1b[31m\xc3\x28" + std::string(100'000, 'x');
  const std::string words = problem(nonsense);
  EXPECT_LT(words.size(), 250U);
  EXPECT_THAT(words, testing::StartsWith("board 'chess??[31m?("));
  for (const char c : words) EXPECT_TRUE(c >= ' ' && c <= '~') << static_cast<int>(c);
}

}  // namespace
}  // namespace handeye
