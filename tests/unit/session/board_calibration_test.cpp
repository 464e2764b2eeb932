// SPDX-License-Identifier: BSD-3-Clause
// A calibration whose eye looks at a board: the same pipeline with a known scale.
#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "daemon/session/board_stage.hpp"
#include "daemon/session/calibration.hpp"
#include "daemon/session/guidance.hpp"
#include "daemon/session/result_json.hpp"
#include "daemon/session/result_message.hpp"
#include "tests/unit/pattern/board_images.hpp"

namespace handeye {
namespace {

constexpr double kFrameRate_hz = 25;
constexpr double kTrackerRate_hz = 60;
constexpr double kTimeOffset_s = 0.023;  // camera stamp minus tracker stamp of the same instant
constexpr std::int64_t kStart_ns = 1'000'000'000'000;
const CameraModel kCamera = test::endoscope();
const Board kBoard = test::chessboard(9, 6, 4);

Pose true_hand_from_eye() {
  return make_pose(Eigen::Quaterniond(0.6, -0.3, 0.7, 0.2), {40, -60, 290});
}

/// The room is the board's frame turned and moved.
Pose room_from_board() {
  return make_pose(Eigen::Quaterniond(0.3, 0.8, -0.2, 0.4), {1200, -300, 900});
}

/// Free-hand over the board, 60 mm above it, not periodic.
Pose board_from_eye(double t) {
  const Eigen::Vector3d tilt(0.30 * std::sin(1.3 * t), 0.28 * std::sin(1.7 * t + 1),
                             0.25 * std::sin(0.9 * t + 2));
  const Eigen::Vector2d shift(4 * std::sin(1.1 * t), 4 * std::sin(1.9 * t + 0.5));
  return test::board_in_view(kBoard, 60 + 8 * std::sin(0.7 * t), tilt, shift).inverse();
}

/// Where the scope is at a time: always moving, or only between the pictures.
using Motion = double (*)(double time_s);
double moving(double time_s) {
  return time_s;
}
/// Rests for a second, is elsewhere a second later.
double stop_and_go(double time_s) {
  const double whole = std::floor(time_s / 2);
  const double rest = time_s - 2 * whole;
  return 0.7 * (whole + std::clamp(rest - 1, 0.0, 1.0));
}

class Instruments {
 public:
  explicit Instruments(Motion motion) : motion_(motion) {}

  HandSample hand(std::int64_t index) {
    const double t = static_cast<double>(index) / kTrackerRate_hz;
    HandSample sample;
    sample.timestamp_ns = kStart_ns + static_cast<std::int64_t>(1e9 * t);
    sample.tracked = true;
    sample.room_from_hand =
        room_from_board() * board_from_eye(motion_(t)) * true_hand_from_eye().inverse();
    sample.room_from_hand.linear() =
        sample.room_from_hand.linear() * exp_so3(rad_from_deg(0.06) * noise3());
    sample.room_from_hand.translation() += 0.15 * noise3();
    return sample;
  }

  TrackedFrame frame(std::int64_t index, double t) {
    TrackedFrame tracked;
    tracked.index = index;
    tracked.timestamp_ns = kStart_ns + static_cast<std::int64_t>(1e9 * (t + kTimeOffset_s));
    const Pose eye_from_board = board_from_eye(motion_(t)).inverse();
    for (const Eigen::Vector3d& corner_mm : kBoard.corners_mm()) {
      const Eigen::Vector3d point_eye = eye_from_board * corner_mm;
      const auto id = static_cast<std::int64_t>(tracked.observations.size());
      tracked.observations.push_back(
          {id, project<double>(kCamera, point_eye) + 0.1 * noise3().head<2>()});
    }
    return tracked;
  }

 private:
  Eigen::Vector3d noise3() { return {noise_(random_), noise_(random_), noise_(random_)}; }

  Motion motion_;
  std::mt19937 random_{11};
  std::normal_distribution<double> noise_{0, 1};
};

CalibrationOptions options() {
  CalibrationOptions options;
  options.start.board = kBoard;
  options.camera = kCamera;
  options.noise.hand_rotation_rad = rad_from_deg(0.06);
  return options;
}

/// With a picture every `interval_s` from `first_s` on.
CalibrationResult calibrate(double duration_s, Motion motion, double first_s, double interval_s) {
  Instruments instruments(motion);
  Calibration calibration(options());
  for (int k = 0; k < duration_s * kTrackerRate_hz; ++k) {
    calibration.add_hand(instruments.hand(k));
  }
  std::int64_t index = 0;
  for (double t = first_s; t < duration_s; t += interval_s) {
    calibration.add_frame(instruments.frame(index++, t));
  }
  return calibration.solve();
}

void expect_true(const CalibrationResult& result, double max_deg, double max_mm) {
  ASSERT_TRUE(result.has_estimate);
  const Pose& found = result.solution.hand_from_eye;
  const Pose truth = true_hand_from_eye();
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found.linear(), truth.linear())), max_deg);
  EXPECT_LT((found.translation() - truth.translation()).norm(), max_mm);
  EXPECT_EQ(result.solution.scale_units_per_mm, 1);
}

TEST(BoardCalibration, FindsTransformationAndTimeOffset) {
  const CalibrationResult result = calibrate(12, moving, 0, 1 / kFrameRate_hz);
  EXPECT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
  expect_true(result, 0.1, 0.5);
  ASSERT_TRUE(result.time_offset_s);
  EXPECT_NEAR(*result.time_offset_s, kTimeOffset_s, 0.001);
  EXPECT_EQ(result.frames.used, result.frames.received);
  EXPECT_EQ(result.features.points, 54);
  EXPECT_NEAR(result.reprojection_px, 0.1 * std::sqrt(2.0), 0.02);
}

TEST(BoardCalibration, ComparesTheMethodsForKnownScale) {
  const CalibrationResult result = calibrate(6, moving, 0, 1 / kFrameRate_hz);
  const std::span<const Method> expected = methods(ScaleMode::kKnown);
  ASSERT_EQ(result.methods.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(result.methods[i].name, expected[i].name);
    ASSERT_TRUE(result.methods[i].solution) << expected[i].name;
    EXPECT_EQ(result.methods[i].solution->scale_units_per_mm, 1) << expected[i].name;
  }
}

TEST(BoardCalibration, NeedsNoTimeOffsetWhereTheScopeRestedAtEveryPicture) {
  const CalibrationResult result = calibrate(24, stop_and_go, 0.5, 2);
  EXPECT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
  expect_true(result, 0.3, 1.5);
  EXPECT_FALSE(result.time_offset_s);
  EXPECT_THAT(result.advice, testing::HasSubstr("stood still"));
}

TEST(BoardCalibration, IsRefusedWithoutTimeOffsetWhereTheScopeMoved) {
  // Too far apart to correlate speeds, and the scope is on its way.
  const CalibrationResult result = calibrate(24, moving, 0.5, 2);
  EXPECT_EQ(result.verdict, Verdict::kRefused);
  EXPECT_EQ(result.reason, Reason::kClockUnstable);
}

TEST(BoardCalibration, NamesTheBoardThatWasNotSeen) {
  Instruments instruments(moving);
  Calibration calibration(options());
  for (int k = 0; k < 5 * kTrackerRate_hz; ++k) calibration.add_hand(instruments.hand(k));
  for (int k = 0; k < 5 * kFrameRate_hz; ++k) {
    calibration.add_frame({.timestamp_ns = kStart_ns + k * 40'000'000LL, .index = k});
  }
  const CalibrationResult result = calibration.solve();
  EXPECT_EQ(result.reason, Reason::kTooFewFeatures);
  EXPECT_THAT(result.advice, testing::HasSubstr("chessboard:9x6:4"));
  EXPECT_EQ(guidance_for(calibration.situation()).words,
            "show the board to the scope: chessboard:9x6:4");
}

TEST(BoardCalibration, BlamesTheViewNotTheMotionWhereTheBoardWasSeldomSeen) {
  Instruments instruments(moving);
  Calibration calibration(options());
  for (int k = 0; k < 12 * kTrackerRate_hz; ++k) calibration.add_hand(instruments.hand(k));
  for (int k = 0; k < 12 * kFrameRate_hz; ++k) {
    TrackedFrame frame = instruments.frame(k, k / kFrameRate_hz);
    if (k > 10) frame.observations.clear();
    calibration.add_frame(frame);
  }
  const CalibrationResult result = calibration.solve();
  EXPECT_EQ(result.verdict, Verdict::kRefused);
  EXPECT_EQ(result.reason, Reason::kTooFewFeatures);
}

TEST(BoardCalibration, ResultSaysWhereTheEyeLooked) {
  CalibrationResult result;
  EXPECT_EQ(to_json(result)["eye"], "sfm");
  EXPECT_FALSE(to_json(result).contains("board"));
  EXPECT_FALSE(from_message(to_message(result)).board);
  result.board = kBoard;
  EXPECT_EQ(to_json(result)["eye"], "pattern");
  EXPECT_EQ(to_json(result)["board"], "chessboard:9x6:4");
  ASSERT_TRUE(from_message(to_message(result)).board);
  EXPECT_EQ(to_string(*from_message(to_message(result)).board), "chessboard:9x6:4");
}

TEST(BoardGuidance, NamesTheFirstThingThatIsMissing) {
  Situation situation{.board = kBoard, .any_frame = true};
  EXPECT_THAT(guidance_for(situation).words, testing::HasSubstr("show the board"));
  situation.keyframes = 1;
  EXPECT_THAT(guidance_for(situation).words, testing::HasSubstr("not wholly in view"));
  situation.board = test::charuco(8, 5, 7, 5);
  EXPECT_THAT(guidance_for(situation).words, testing::HasSubstr("board not in view"));
  situation.state = ReconstructionState::kTracking;
  EXPECT_EQ(guidance_for(situation).words, "tilt the scope up and down");
  situation.rotation_coverage_deg = 30;
  situation.second_axis_deg = 8;
  EXPECT_EQ(guidance_for(situation).words, "") << "against a board nothing needs to slide";
}

TEST(BoardStage, HandsOnTheCornersOfEveryImage) {
  test::BoardImages images(kBoard, kCamera);
  BoardStage stage(kBoard);
  Frame frame;
  TrackedFrame tracked;
  frame.timestamp_ns = 5;
  frame.grey = images.image(board_from_eye(0.3).inverse());
  stage.process(frame, tracked);
  EXPECT_EQ(tracked.timestamp_ns, 5);
  EXPECT_EQ(tracked.index, 0);
  EXPECT_EQ(tracked.observations.size(), 54U);
  frame.grey = cv::Mat::zeros(480, 640, CV_8UC1);
  stage.process(frame, tracked);
  EXPECT_EQ(tracked.index, 1);
  EXPECT_TRUE(tracked.observations.empty());
}

TEST(BoardStage, FindsNothingInAnImageThatOpenCvThrowsAt) {
  Frame frame;
  frame.timestamp_ns = 5;
  for (const cv::Mat& grey : {cv::Mat(), cv::Mat(cv::Mat::zeros(48, 64, CV_32FC1))}) {
    BoardStage stage(test::charuco(8, 5, 7, 5));
    frame.grey = grey;
    TrackedFrame tracked;
    tracked.observations.resize(3);
    stage.process(frame, tracked);
    EXPECT_TRUE(tracked.observations.empty());
    EXPECT_EQ(tracked.timestamp_ns, 5);
    EXPECT_EQ(tracked.condition, ImageCondition::kUnusable);
    EXPECT_EQ(stage.failures(), 1);
    EXPECT_FALSE(stage.failure().empty());
  }
}

TEST(BoardStage, GoesOnAfterADetectorThatThrows) {
  struct Throwing final : BoardDetector {
    int images{0};
    void detect(const cv::Mat& /*grey*/, std::vector<BoardCorner>& corners) override {
      corners.assign(1, {0, {1, 2}});
      if (++images == 2) CV_Error(cv::Error::StsBadArg, "too small");
    }
  };
  BoardStage stage(std::make_unique<Throwing>());
  test::BoardImages images(kBoard, kCamera);
  Frame frame;
  TrackedFrame tracked;
  std::vector<std::size_t> corners;
  for (std::int64_t i = 0; i < 3; ++i) {
    frame.grey = images.image(board_from_eye(0.3 * static_cast<double>(i)).inverse());
    stage.process(frame, tracked);
    EXPECT_EQ(tracked.index, i);
    corners.push_back(tracked.observations.size());
  }
  EXPECT_THAT(corners, testing::ElementsAre(1, 0, 1));
  EXPECT_EQ(stage.failures(), 1);
  EXPECT_EQ(stage.failure(), "too small");
}

}  // namespace
}  // namespace handeye
