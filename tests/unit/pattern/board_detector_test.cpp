// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/board_detector.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/unit/pattern/board_images.hpp"

namespace handeye {
namespace {

using test::board_in_view;
using test::BoardImages;

const Eigen::Vector3d kTilts[] = {{0, 0, 0},        {0.5, 0, 0.1},   {-0.4, 0.3, -0.6},
                                  {0.1, -0.6, 1.4}, {0.3, 0.2, 2.9}, {-0.2, 0.1, -2}};

std::vector<BoardCorner> detect(BoardDetector& detector, const cv::Mat& grey) {
  std::vector<BoardCorner> corners;
  detector.detect(grey, corners);
  return corners;
}

/// What a marker leaves of a ChArUco corner's surroundings to look at is small.
double expected_rms_px(const Board& board) {
  return board.kind == Board::Kind::kChessboard ? 0.1 : 0.15;
}

/// All of them, in order, near the truth.
void expect_all(const std::vector<BoardCorner>& corners,
                const std::vector<Eigen::Vector2d>& truth_px, double max_rms_px) {
  ASSERT_EQ(corners.size(), truth_px.size());
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(corners[i].id, static_cast<int>(i));
    sum += (corners[i].pixel - truth_px[i]).squaredNorm();
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(corners.size())), max_rms_px);
}

/// A wall with blobs, no board.
cv::Mat tissue() {
  cv::Mat grey(480, 640, CV_8UC1);
  cv::RNG random(3);
  random.fill(grey, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(grey, grey, cv::Size(0, 0), 6);
  cv::normalize(grey, grey, 0, 255, cv::NORM_MINMAX);
  return grey;
}

class EveryBoard : public testing::TestWithParam<Board> {};

TEST_P(EveryBoard, IsFoundCornerByCornerAtAnyAttitude) {
  BoardImages images(GetParam(), test::endoscope());
  for (const Eigen::Vector3d& tilt : kTilts) {
    SCOPED_TRACE(testing::Message() << "tilt " << tilt.transpose());
    const Pose eye_from_board = board_in_view(GetParam(), 80, tilt, {2, -1});
    const auto detector = make_board_detector(GetParam());
    expect_all(detect(*detector, images.image(eye_from_board)), images.true_pixels(eye_from_board),
               expected_rms_px(GetParam()));
  }
}

TEST_P(EveryBoard, IsFoundInALargeImageAtItsFullPrecision) {
  const CameraModel camera{1920, 1080, 1560, 1560, 960, 540, {-0.2, 0.05, 0, 0, 0}};
  BoardImages images(GetParam(), camera);
  const Pose eye_from_board = board_in_view(GetParam(), 90, {0.3, -0.2, 0.4});
  const auto detector = make_board_detector(GetParam());
  expect_all(detect(*detector, images.image(eye_from_board)), images.true_pixels(eye_from_board),
             expected_rms_px(GetParam()));
}

TEST_P(EveryBoard, IsNotFoundWhereThereIsNone) {
  const auto detector = make_board_detector(GetParam());
  EXPECT_TRUE(detect(*detector, tissue()).empty());
  EXPECT_TRUE(detect(*detector, cv::Mat::zeros(480, 640, CV_8UC1)).empty());
  const auto thorough = make_board_detector(GetParam(), {.thorough = true});
  EXPECT_TRUE(detect(*thorough, tissue()).empty());
}

TEST_P(EveryBoard, LeavesNothingOfTheImageBefore) {
  BoardImages images(GetParam(), test::endoscope());
  const auto detector = make_board_detector(GetParam());
  std::vector<BoardCorner> corners;
  detector->detect(images.image(board_in_view(GetParam(), 80, {0.2, 0.1, 0})), corners);
  ASSERT_FALSE(corners.empty());
  detector->detect(tissue(), corners);
  EXPECT_TRUE(corners.empty());
}

/// A lost board is looked for in one way an image; within three it is found again.
TEST_P(EveryBoard, IsFoundAgainSoonAfterItWasLost) {
  BoardImages images(GetParam(), test::endoscope());
  const auto detector = make_board_detector(GetParam());
  for (int lost = 1; lost <= 4; ++lost) {
    for (int k = 0; k < lost; ++k) EXPECT_TRUE(detect(*detector, tissue()).empty());
    const cv::Mat seen = images.image(board_in_view(GetParam(), 80, {0.2, 0.1, 0}));
    bool found = false;
    for (int k = 0; k < 3 && !found; ++k) found = !detect(*detector, seen).empty();
    EXPECT_TRUE(found) << "after " << lost;
  }
}

TEST_P(EveryBoard, IsNotFoundInAnImageTooSmallForIt) {
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(8, 8), cv::Size(1, 480), cv::Size(2000, 1)}) {
    SCOPED_TRACE(testing::Message() << size);
    cv::Mat grey(size, CV_8UC1);
    cv::RNG(1).fill(grey, cv::RNG::UNIFORM, 0, 256);
    for (const bool thorough : {false, true}) {
      const auto detector = make_board_detector(GetParam(), {.thorough = thorough});
      EXPECT_TRUE(detect(*detector, grey).empty());
      EXPECT_TRUE(detect(*detector, grey).empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Boards, EveryBoard,
                         testing::Values(test::chessboard(9, 6, 6), test::chessboard(4, 7, 7),
                                         test::charuco(8, 5, 7, 5), test::charuco(5, 6, 8, 6),
                                         test::charuco(3, 3, 14, 10)),
                         [](const auto& board) {
                           std::string name = to_string(board.param);
                           std::ranges::replace_if(
                               name, [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

/// Falling off from the middle to the edge, as an endoscope's own light does.
cv::Mat lit_from_the_middle(const cv::Mat& grey) {
  cv::Mat lit = grey.clone();
  for (int row = 0; row < lit.rows; ++row) {
    for (int column = 0; column < lit.cols; ++column) {
      const double radius = std::hypot(column - 280, row - 220) / 320;
      auto& pixel = lit.at<std::uint8_t>(row, column);
      pixel = cv::saturate_cast<std::uint8_t>(1.3 * pixel / (1 + 4 * radius * radius));
    }
  }
  return lit;
}

TEST_P(EveryBoard, IsFoundInAnEndoscopesLight) {
  BoardImages images(GetParam(), test::endoscope());
  const Pose eye_from_board = board_in_view(GetParam(), 85, {0.2, -0.2, 0.4});
  const cv::Mat grey = lit_from_the_middle(images.image(eye_from_board));
  const auto detector = make_board_detector(GetParam());
  expect_all(detect(*detector, grey), images.true_pixels(eye_from_board), 0.3);
}

TEST(Charuco, NamesTheDictionariesAsOpenCvNumbersThem) {
  for (std::size_t i = 0; i < kMarkerDictionaries.size(); ++i) {
    const MarkerDictionary& named = kMarkerDictionaries[i];
    const auto dictionary = cv::aruco::getPredefinedDictionary(static_cast<int>(i));
    EXPECT_EQ(dictionary->bytesList.rows, named.markers) << named.name;
    const std::string side = std::to_string(dictionary->markerSize);
    if (named.name.find('X') != std::string_view::npos && named.name.find("APRIL") != 5) {
      EXPECT_EQ(named.name.substr(5, 3), side + 'X' + side);
    }
  }
  const auto index = [](std::string_view name) { return dictionary_index(name).value(); };
  EXPECT_EQ(index("DICT_4X4_50"), cv::aruco::DICT_4X4_50);
  EXPECT_EQ(index("DICT_ARUCO_ORIGINAL"), cv::aruco::DICT_ARUCO_ORIGINAL);
  EXPECT_EQ(index("DICT_APRILTAG_16H5"), cv::aruco::DICT_APRILTAG_16h5);
  EXPECT_EQ(index("DICT_APRILTAG_36H11"), cv::aruco::DICT_APRILTAG_36h11);
  EXPECT_FALSE(dictionary_index("DICT_4X4"));
}

TEST(Charuco, OfEveryDictionaryIsDetected) {
  for (const MarkerDictionary& dictionary : kMarkerDictionaries) {
    Board board = test::charuco(7, 8, 7, 5);
    board.dictionary = dictionary.name;
    EXPECT_TRUE(detect(*make_board_detector(board), tissue()).empty()) << dictionary.name;
  }
}

TEST(Chessboard, IsFoundWhollyOrNotAtAll) {
  const Board board = test::chessboard(9, 6, 6);
  BoardImages images(board, test::endoscope());
  const auto detector = make_board_detector(board);
  EXPECT_TRUE(
      detect(*detector, images.image(board_in_view(board, 80, {0, 0, 0}, {35, 0}))).empty());
}

TEST(Charuco, IsFoundInPart) {
  const Board board = test::charuco(8, 5, 7, 5);
  BoardImages images(board, test::endoscope());
  const auto detector = make_board_detector(board);
  const Pose eye_from_board = board_in_view(board, 80, {0.1, 0, 0}, {38, 0});
  const std::vector<Eigen::Vector2d> truth_px = images.true_pixels(eye_from_board);
  const std::vector<BoardCorner> corners = detect(*detector, images.image(eye_from_board));
  ASSERT_GE(corners.size(), 6U);
  EXPECT_LT(corners.size(), truth_px.size());
  for (const BoardCorner& corner : corners) {
    EXPECT_LT((corner.pixel - truth_px[static_cast<std::size_t>(corner.id)]).norm(), 0.3);
  }
}

TEST(Boards, SaysWhichAreAmbiguous) {
  EXPECT_FALSE(is_ambiguous(test::chessboard(9, 6, 6)));
  EXPECT_TRUE(is_ambiguous(test::chessboard(8, 6, 6)));
  EXPECT_TRUE(is_ambiguous(test::chessboard(7, 7, 6)));
  EXPECT_FALSE(is_ambiguous(test::charuco(8, 6, 6, 4)));
}

TEST(AmbiguousChessboard, KeepsItsOrderWhileTheCameraRollsOver) {
  const Board board = test::chessboard(8, 6, 6);
  BoardImages images(board, test::endoscope());
  const auto detector = make_board_detector(board);
  for (double roll = 0; roll < 3.3; roll += 0.4) {
    SCOPED_TRACE(roll);
    const Pose eye_from_board = board_in_view(board, 80, {0.2, 0.1, roll});
    expect_all(detect(*detector, images.image(eye_from_board)), images.true_pixels(eye_from_board),
               0.1);
  }
}

TEST(AmbiguousChessboard, MayBeTheSmallestThereIs) {
  const Board board = test::chessboard(3, 3, 10);
  BoardImages images(board, test::endoscope());
  const auto detector = make_board_detector(board);
  const Pose eye_from_board = board_in_view(board, 80, {0.2, 0.1, 0.3});
  expect_all(detect(*detector, images.image(eye_from_board)), images.true_pixels(eye_from_board),
             0.1);
  const auto thorough = make_board_detector(board, {.thorough = true});
  for (const int side : {1, 8}) {
    const cv::Mat grey = cv::Mat::zeros(side, side, CV_8UC1);
    EXPECT_TRUE(detect(*detector, grey).empty()) << side;
    EXPECT_TRUE(detect(*thorough, grey).empty()) << side;
  }
}

TEST(AmbiguousChessboard, IsLeftOutAfterATurnThatCouldBeTwo) {
  const Board board = test::chessboard(8, 6, 6);
  BoardImages images(board, test::endoscope());
  const auto detector = make_board_detector(board);
  ASSERT_FALSE(detect(*detector, images.image(board_in_view(board, 80, {0, 0, 0}))).empty());
  EXPECT_TRUE(detect(*detector, images.image(board_in_view(board, 80, {0, 0, 1.5}))).empty());
}

TEST(RealData, EveryChessboardOfTheRobotIsFound) {
  const char* configured = std::getenv("HANDEYE_DATA");
  const std::filesystem::path frames =
      (configured != nullptr ? std::filesystem::path(configured)
                             : std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data") /
      "chessboard" / "frames";
  if (!std::filesystem::exists(frames)) GTEST_SKIP() << frames << " is not there: set HANDEYE_DATA";
  const auto detector = make_board_detector(test::chessboard(9, 6, 23.6));
  for (int i = 1; i <= 8; ++i) {
    const cv::Mat grey =
        cv::imread((frames / (std::to_string(i) + ".png")).string(), cv::IMREAD_GRAYSCALE);
    EXPECT_EQ(detect(*detector, grey).size(), 54U) << i;
  }
}

}  // namespace
}  // namespace handeye
