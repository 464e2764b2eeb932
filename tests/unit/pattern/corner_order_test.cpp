// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/corner_order.hpp"

#include <gtest/gtest.h>

#include "tests/unit/pattern/board_images.hpp"

namespace handeye {
namespace {

struct View {
  cv::Mat grey;
  std::vector<cv::Point2f> corners;
};

View view(int columns, int rows) {
  const Board board = test::chessboard(columns, rows, 6);
  test::BoardImages images(board, {640, 480, 520, 520, 320, 240, {}});
  const Pose eye_from_board = test::board_in_view(board, 80, {0.2, -0.1, 0.3});
  View view{images.image(eye_from_board), {}};
  for (const Eigen::Vector2d& pixel : images.true_pixels(eye_from_board)) {
    view.corners.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  }
  return view;
}

std::vector<cv::Point2f> mirrored(const std::vector<cv::Point2f>& corners, int columns) {
  std::vector<cv::Point2f> result;
  for (std::size_t row = corners.size() / static_cast<std::size_t>(columns); row-- > 0;) {
    const auto begin = corners.begin() + static_cast<std::ptrdiff_t>(row) * columns;
    result.insert(result.end(), begin, begin + columns);
  }
  return result;
}

TEST(CornerOrder, IsTheSameFromEveryOrderThatADetectorMayGive) {
  const View seen = view(9, 6);
  const std::vector<cv::Point2f> reversed(seen.corners.rbegin(), seen.corners.rend());
  for (std::vector<cv::Point2f> corners :
       {seen.corners, reversed, mirrored(seen.corners, 9), mirrored(reversed, 9)}) {
    ASSERT_TRUE(CornerOrder(9, 6).arrange(seen.grey, corners));
    EXPECT_EQ(corners, seen.corners);
  }
}

TEST(CornerOrder, OfASquareBoardIsOneOfItsOwn) {
  for (const int side : {6, 7}) {
    SCOPED_TRACE(side);
    const View seen = view(side, side);
    CornerOrder order(side, side);
    std::vector<cv::Point2f> corners = seen.corners;
    ASSERT_TRUE(order.arrange(seen.grey, corners));
    EXPECT_EQ(corners, seen.corners) << "the first row points to the right";
    // By rows or by columns, from either end: the same as in the image before.
    std::vector<cv::Point2f> by_columns;
    for (int column = 0; column < side; ++column) {
      for (int row = 0; row < side; ++row) {
        by_columns.push_back(seen.corners[static_cast<std::size_t>(row * side + column)]);
      }
    }
    for (std::vector<cv::Point2f> found :
         {by_columns, std::vector<cv::Point2f>(by_columns.rbegin(), by_columns.rend())}) {
      ASSERT_TRUE(order.arrange(seen.grey, found));
      EXPECT_EQ(found, seen.corners);
    }
  }
}

TEST(CornerOrder, ForgetsAnAmbiguousBoardThatIsRefusedForASecond) {
  const auto rolled = [](double roll) {
    const Board board = test::chessboard(8, 6, 6);
    test::BoardImages images(board, {640, 480, 520, 520, 320, 240, {}});
    const Pose eye_from_board = test::board_in_view(board, 80, {0, 0, roll});
    View view{images.image(eye_from_board), {}};
    for (const Eigen::Vector2d& pixel : images.true_pixels(eye_from_board)) {
      view.corners.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    }
    return view;
  };
  CornerOrder order(8, 6);
  View before = rolled(0);
  ASSERT_TRUE(order.arrange(before.grey, before.corners));
  const View turned = rolled(1.5);
  for (int image = 0; image < 25; ++image) {
    auto corners = turned.corners;
    EXPECT_FALSE(order.arrange(turned.grey, corners)) << image;
  }
  auto corners = turned.corners;
  EXPECT_TRUE(order.arrange(turned.grey, corners));
  EXPECT_TRUE(order.arrange(turned.grey, corners)) << "and is followed from then on";
}

TEST(CornerOrder, RefusesWhatDoesNotAlternate) {
  View seen = view(9, 6);
  EXPECT_FALSE(CornerOrder(9, 6).arrange(cv::Mat::ones(480, 640, CV_8UC1), seen.corners));
}

}  // namespace
}  // namespace handeye
