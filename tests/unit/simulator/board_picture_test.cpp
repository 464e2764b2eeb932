// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/board_picture.hpp"

#include <variant>

#include <gtest/gtest.h>
#include <opencv2/aruco/charuco.hpp>

#include "drivers/simulator/random_stream.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

Board board_of(const char* text) {
  return std::get<Board>(parse_board(text));
}

float at(const BoardPicture& picture, double x, double y) {
  return picture.mean({x, y, 1e-6, 1e-6});
}

TEST(BoardPicture, CornersLieBetweenSquares) {
  const Board board = board_of("chessboard:7x5:10");
  const BoardPicture picture(board);
  const float white = at(picture, -15, 5);
  EXPECT_LT(white, 255);
  for (const Eigen::Vector3d& corner : board.corners_mm()) {
    const int parity = static_cast<int>(corner.x() / 10 + corner.y() / 10) % 2;
    const float upper_left = at(picture, corner.x() - 1, corner.y() - 1);
    const float upper_right = at(picture, corner.x() + 1, corner.y() - 1);
    EXPECT_EQ(upper_left, at(picture, corner.x() + 1, corner.y() + 1));
    EXPECT_EQ(upper_right, at(picture, corner.x() - 1, corner.y() + 1));
    EXPECT_EQ(parity == 0 ? upper_right : upper_left, white);
    EXPECT_LT(parity == 0 ? upper_left : upper_right, 0.2F * white);
    EXPECT_GT(parity == 0 ? upper_left : upper_right, 0);
  }
  // Margin of one square, then the table.
  EXPECT_EQ(at(picture, -19.9, -19.9), white);
  EXPECT_EQ(at(picture, 79.9, 59.9), white);
  EXPECT_LT(at(picture, -20.1, 0), 0.5F * white);
  EXPECT_LT(at(picture, 0, 60.1), 0.5F * white);
}

TEST(BoardPicture, MeansOverBoxesAreExact) {
  // The mean of a box is the mean of its parts, however it is cut, inside, across and outside.
  for (const char* text : {"chessboard:7x5:10", "charuco:6x5:10:7:DICT_6X6_50"}) {
    const BoardPicture picture(board_of(text));
    RandomStream random(1, Purpose::kTexture);
    for (int i = 0; i < 2'000; ++i) {
      const double x = random.uniform(-30, 80);
      const double y = random.uniform(-30, 70);
      const double width = random.uniform(0.01, 30);
      const double height = random.uniform(0.01, 30);
      const double cut = random.uniform(0.1, 0.9);
      const float whole = picture.mean({x, y, width, height});
      const float left = picture.mean({x - 0.5 * width * (1 - cut), y, width * cut, height});
      const float right = picture.mean({x + 0.5 * width * cut, y, width * (1 - cut), height});
      EXPECT_NEAR(whole, cut * static_cast<double>(left) + (1 - cut) * static_cast<double>(right),
                  1e-3);
      const float upper = picture.mean({x, y - 0.5 * height * (1 - cut), width, height * cut});
      const float lower = picture.mean({x, y + 0.5 * height * cut, width, height * (1 - cut)});
      EXPECT_NEAR(whole, cut * static_cast<double>(upper) + (1 - cut) * static_cast<double>(lower),
                  1e-3);
    }
  }
}

TEST(BoardPicture, IsOpenCvsBoardModuleByModule) {
  struct Case {
    const char* text;
    int dictionary;
    float marker_mm;
  };
  // Even and odd numbers of rows: OpenCV once began them differently.
  for (const Case& each :
       {Case{"charuco:8x6:8:6:DICT_4X4_50", cv::aruco::DICT_4X4_50, 6.0F},
        Case{"charuco:5x7:8:6:DICT_4X4_100", cv::aruco::DICT_4X4_100, 6.0F},
        Case{"charuco:6x5:10:8:DICT_APRILTAG_36H11", cv::aruco::DICT_APRILTAG_36h11, 8.0F}}) {
    const Board board = board_of(each.text);
    const BoardPicture picture(board);
    const auto drawn_board = cv::aruco::CharucoBoard::create(
        board.columns, board.rows, static_cast<float>(board.square_mm), each.marker_mm,
        cv::aruco::getPredefinedDictionary(each.dictionary));
    constexpr int kPxPerMm = 10;
    const int square_px = static_cast<int>(board.square_mm) * kPxPerMm;
    cv::Mat drawn;
    drawn_board->draw({board.columns * square_px, board.rows * square_px}, drawn);
    // In the middle of every half millimetre, which is at most half a module.
    int differences = 0;
    for (int row = 2; row < drawn.rows; row += kPxPerMm / 2) {
      for (int column = 2; column < drawn.cols; column += kPxPerMm / 2) {
        const float albedo = at(picture, (column + 0.5) / kPxPerMm - board.square_mm,
                                (row + 0.5) / kPxPerMm - board.square_mm);
        differences +=
            static_cast<int>((albedo > 90) != (drawn.at<std::uint8_t>(row, column) > 90));
      }
    }
    EXPECT_EQ(differences, 0) << each.text;
  }
}

TEST(BoardPicture, RefusesABoardWithTooFewMarkers) {
  EXPECT_NO_THROW(BoardPicture(board_of("charuco:10x10:4:3:DICT_4X4_50")));
  Board too_large = board_of("charuco:10x10:4:3:DICT_4X4_50");
  too_large.columns = 11;
  EXPECT_THROW(BoardPicture{too_large}, UsageError);
}

}  // namespace
}  // namespace handeye::simulator
