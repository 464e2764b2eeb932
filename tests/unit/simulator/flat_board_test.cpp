// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/simulator/renderer.hpp"
#include "drivers/simulator/truth_file.hpp"
#include "drivers/simulator/world.hpp"

namespace handeye::simulator {
namespace {

constexpr double kFrameSpacing_s = 0.8;
constexpr int kFrames = 25;

/// A board as the endoscope sees it on its way, and where its corners truly show.
class BoardScene {
 public:
  BoardScene(const char* board, std::uint64_t seed, double noise_grey)
      : world_(options_of(board, seed), 0),
        renderer_(world_.surface, world_.camera, seed, {.noise_grey = noise_grey}) {}

  const Board& board() const { return *world_.options.board; }

  void look(int frame) {
    const double time_s = kFrameSpacing_s * frame;
    renderer_.render(world_.motion.surface_from_eye(time_s), static_cast<std::uint64_t>(frame),
                     grey_);
    const Pose eye_from_board =
        world_.room_from_eye(time_s).inverse() * world_.room_from_board().value();
    truth_px_.clear();
    for (const Eigen::Vector3d& corner_mm : board().corners_mm()) {
      truth_px_.push_back(project<double>(world_.camera, eye_from_board * corner_mm));
    }
  }

  const cv::Mat& grey() const { return grey_; }
  const std::vector<Eigen::Vector2d>& truth_px() const { return truth_px_; }

  /// All corners inside the image, their squares' halves too.
  bool sees_all() const {
    constexpr double kBorderPx = 15;
    return std::ranges::all_of(truth_px_, [this](const Eigen::Vector2d& corner) {
      return corner.x() > kBorderPx && corner.y() > kBorderPx &&
             corner.x() < world_.camera.width - 1 - kBorderPx &&
             corner.y() < world_.camera.height - 1 - kBorderPx;
    });
  }

 private:
  static SimulatorOptions options_of(const char* board, std::uint64_t seed) {
    SimulatorOptions options;
    options.seed = seed;
    options.board = std::get<Board>(parse_board(board));
    return options;
  }

  World world_;
  Renderer renderer_;
  cv::Mat grey_;
  std::vector<Eigen::Vector2d> truth_px_;
};

/// How far found corners are from the truth.
class CornerErrors {
 public:
  void add(const cv::Point2f& found, const Eigen::Vector2d& truth) {
    const Eigen::Vector2d error(static_cast<double>(found.x) - truth.x(),
                                static_cast<double>(found.y) - truth.y());
    sum_ += error;
    squares_ += error.squaredNorm();
    largest_px_ = std::max(largest_px_, error.norm());
    ++count_;
  }

  int count() const { return count_; }
  double rms_px() const { return std::sqrt(squares_ / count_); }
  double largest_px() const { return largest_px_; }
  double bias_px() const { return sum_.norm() / count_; }

 private:
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();
  double squares_{0};
  double largest_px_{0};
  int count_{0};
};

void refine(const cv::Mat& grey, int half_window, std::vector<cv::Point2f>& corners) {
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-4);
  cv::cornerSubPix(grey, corners, {half_window, half_window}, {-1, -1}, until);
}

TEST(FlatBoard, ChessboardCornersAreFoundWhereTheyAre) {
  for (const double noise_grey : {0.0, ImagingOptions{}.noise_grey}) {
    BoardScene scene("chessboard:9x6:4", 3, noise_grey);
    CornerErrors errors;
    int seen = 0;
    int found = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
      scene.look(frame);
      if (!scene.sees_all()) continue;
      ++seen;
      std::vector<cv::Point2f> corners;
      if (!cv::findChessboardCorners(scene.grey(), {9, 6}, corners)) continue;
      ++found;
      refine(scene.grey(), 5, corners);
      for (std::size_t i = 0; i < corners.size(); ++i) errors.add(corners[i], scene.truth_px()[i]);
    }
    // The size that --help recommends is mostly in view.
    EXPECT_GE(seen, kFrames * 3 / 4);
    EXPECT_GE(found, seen - 1);
    EXPECT_LT(errors.rms_px(), 0.05) << "noise " << noise_grey;
    EXPECT_LT(errors.largest_px(), 0.25) << "noise " << noise_grey;
    EXPECT_LT(errors.bias_px(), 0.005) << "noise " << noise_grey;
  }
}

TEST(FlatBoard, CharucoCornersAreFoundUnderTheirNumbers) {
  BoardScene scene("charuco:8x6:6:4.5:DICT_4X4_50", 4, ImagingOptions{}.noise_grey);
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  const auto board = cv::aruco::CharucoBoard::create(8, 6, 6.0F, 4.5F, dictionary);
  CornerErrors errors;
  int seen = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    scene.look(frame);
    if (!scene.sees_all()) continue;
    seen += static_cast<int>(scene.truth_px().size());
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> marker_ids;
    cv::aruco::detectMarkers(scene.grey(), dictionary, markers, marker_ids);
    ASSERT_FALSE(markers.empty());
    std::vector<cv::Point2f> corners;
    std::vector<int> ids;
    cv::aruco::interpolateCornersCharuco(markers, marker_ids, scene.grey(), board, corners, ids);
    ASSERT_FALSE(corners.empty());
    // Small enough to keep clear of the markers.
    refine(scene.grey(), 4, corners);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      errors.add(corners[i], scene.truth_px()[static_cast<std::size_t>(ids[i])]);
    }
  }
  EXPECT_GE(seen, 35 * kFrames / 2);
  EXPECT_GE(errors.count(), seen * 9 / 10);
  EXPECT_LT(errors.rms_px(), 0.05);
  EXPECT_LT(errors.largest_px(), 0.25);
  EXPECT_LT(errors.bias_px(), 0.005);
}

TEST(FlatBoard, IsNeitherBlackNorClipped) {
  BoardScene scene("chessboard:9x6:4", 6, ImagingOptions{}.noise_grey);
  for (int frame = 0; frame < kFrames; ++frame) {
    scene.look(frame);
    const auto pixels = static_cast<int>(scene.grey().total());
    EXPECT_LT(cv::countNonZero(scene.grey() == 255), pixels / 100) << "frame " << frame;
    EXPECT_LT(cv::countNonZero(scene.grey() == 0), pixels / 100) << "frame " << frame;
  }
}

TEST(FlatBoard, TruthSaysWhereTheBoardIs) {
  SimulatorOptions options;
  options.seed = 9;
  EXPECT_FALSE(truth_json(World(options, 0)).contains("board"));

  options.board = std::get<Board>(parse_board("charuco:5x7:4:3:DICT_5X5_100"));
  const World world(options, 0);
  const auto truth = truth_json(world);
  EXPECT_EQ(truth.at("board"), "charuco:5x7:4:3:DICT_5X5_100");
  const auto t = truth.at("room_from_board").at("t_mm").get<std::vector<double>>();
  const Eigen::Vector3d first_corner_in_surface =
      world.room_from_surface.inverse() * Eigen::Vector3d(t[0], t[1], t[2]);
  // 4 x 6 corners around the middle; y of the surface points up for whom the board is upright.
  EXPECT_TRUE(first_corner_in_surface.isApprox(Eigen::Vector3d(-6, 10, 0), 1e-9));
  const Eigen::Vector3d into_board = world.room_from_board()->linear().col(2);
  EXPECT_TRUE(into_board.isApprox(-world.room_from_surface.linear().col(2), 1e-12));
}

}  // namespace
}  // namespace handeye::simulator
