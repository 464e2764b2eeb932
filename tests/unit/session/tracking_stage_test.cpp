// SPDX-License-Identifier: BSD-3-Clause
// What a calibration makes of an endoscope's troubles, on rendered sequences with known truth.
#include "daemon/session/tracking_stage.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/session/calibration.hpp"
#include "tests/sequences/sequence.hpp"

namespace handeye {
namespace {

using sequences::Sequence;
using sequences::SequenceFrame;
using sequences::SequenceOptions;

SequenceOptions lasting(double duration_s) {
  SequenceOptions options;
  options.duration_s = duration_s;
  return options;
}

/// Where features are in an image, by their ids.
std::map<std::int64_t, Eigen::Vector2d> features_of(const TrackedFrame& tracked) {
  std::map<std::int64_t, Eigen::Vector2d> features;
  for (const Observation& seen : tracked.observations) features[seen.feature_id] = seen.pixel;
  return features;
}

TEST(TrackingStage, FeaturesOutliveImagesThatShowNothing) {
  Sequence sequence("plain", lasting(1.2));
  TrackingStage stage({});
  SequenceFrame rendered;
  TrackedFrame tracked;
  std::map<std::int64_t, Eigen::Vector2d> before;
  cv::Mat shown;
  for (std::int64_t index = 0; sequence.next(rendered); ++index) {
    const bool dark = index >= 10 && index < 13;
    const bool frozen = index >= 20 && index < 23;
    if (!frozen) rendered.grey.copyTo(shown);
    if (dark) shown = cv::Scalar(2);
    if (index == 10 || index == 20) before = features_of(tracked);
    Frame frame;
    frame.timestamp_ns = rendered.timestamp_ns;
    frame.grey = shown;
    stage.process(frame, tracked);
    EXPECT_EQ(tracked.index, index);
    EXPECT_EQ(tracked.timestamp_ns, rendered.timestamp_ns);
    const ImageCondition expected = dark     ? ImageCondition::kDark
                                    : frozen ? ImageCondition::kFrozen
                                             : ImageCondition::kGood;
    EXPECT_EQ(tracked.condition, expected) << index;
    EXPECT_EQ(tracked.observations.empty(), dark || frozen) << index;
    if (index == 13 || index == 23) {
      const auto after = features_of(tracked);
      const auto survivors = std::ranges::count_if(
          before, [&](const auto& feature) { return after.contains(feature.first); });
      EXPECT_GT(static_cast<double>(survivors), 0.6 * static_cast<double>(before.size())) << index;
    }
  }
}

/// Median distance between where features are tracked to and where they truly went, over 10 frames
/// [px], after the first ten.
double tracking_error_px(const std::string& name, int& interlaced) {
  Sequence sequence(name, lasting(2.4));
  TrackingStage stage({});
  SequenceFrame rendered;
  TrackedFrame tracked;
  std::map<std::int64_t, Eigen::Vector2d> start;
  cv::Mat1f start_depth_mm;
  Pose scene_from_start = Pose::Identity();
  std::vector<double> errors_px;
  for (int index = 0; sequence.next(rendered); ++index) {
    Frame frame;
    frame.timestamp_ns = rendered.timestamp_ns;
    frame.grey = rendered.grey;
    stage.process(frame, tracked);
    interlaced += tracked.condition == ImageCondition::kInterlaced;
    if (index < 20 || index % 10 != 0) continue;
    for (const auto& [id, pixel] : features_of(tracked)) {
      const auto before = start.find(id);
      if (before == start.end()) continue;
      const auto truth = sequences::true_pixel(sequence.camera(), start_depth_mm, scene_from_start,
                                               before->second, rendered.scene_from_eye);
      if (truth) errors_px.push_back((pixel - *truth).norm());
    }
    start = features_of(tracked);
    rendered.depth_mm.copyTo(start_depth_mm);
    scene_from_start = rendered.scene_from_eye;
  }
  std::ranges::sort(errors_px);
  return errors_px.size() < 300 ? 1e9 : errors_px[errors_px.size() / 2];
}

TEST(TrackingStage, OfInterlacedImagesOneFieldIsTrackedWhereItTrulyWas) {
  int interlaced = 0;
  EXPECT_LT(tracking_error_px("interlaced", interlaced), 0.25);
  EXPECT_GT(interlaced, 40);
  int progressive = 0;
  EXPECT_LT(tracking_error_px("plain", progressive), 0.25);
  EXPECT_EQ(progressive, 0);
}

TEST(TrackingStage, HighlightsAreLeftOutAndLittleElse) {
  Sequence wet("highlights", lasting(1.0));
  Sequence dry("plain", lasting(1.0));
  Highlights highlights;
  SequenceFrame with, without;
  double glints = 0, missed = 0, other = 0, lost = 0;
  while (wet.next(with) && dry.next(without)) {
    cv::Mat brighter;
    cv::subtract(with.grey, without.grey, brighter);
    const cv::Mat glint = (brighter > 60) & (with.grey > 220);
    cv::Mat about;
    cv::dilate(brighter > 12, about, cv::getStructuringElement(cv::MORPH_ELLIPSE, {17, 17}));
    const cv::Mat usable = highlights.usable(with.grey, cv::Mat(with.grey.size(), CV_8UC1, 255));
    glints += cv::countNonZero(glint);
    missed += cv::countNonZero(glint & usable);
    other += cv::countNonZero(~about);
    lost += cv::countNonZero(~about & ~usable);
  }
  ASSERT_GT(glints, 1000);
  EXPECT_LT(missed, 0.05 * glints);
  EXPECT_LT(lost, 0.01 * other);
  RecordProperty("missed_permille", static_cast<int>(1000 * missed / glints));
  RecordProperty("lost_permille", static_cast<int>(1000 * lost / other));
}

/// Calibrates on a plain sequence whose images `trouble` may replace; it is told the time [s].
using Trouble = std::function<void(double time_s, cv::Mat& grey)>;

struct Calibrated {
  CalibrationResult result;
  Pose truth{Pose::Identity()};
};

/// `times_shown`: by a grabber so many times as fast as its camera.
Calibrated calibrate(double duration_s, const Trouble& trouble, int times_shown = 1) {
  const SequenceOptions sequence_options = lasting(duration_s);
  Sequence sequence("plain", sequence_options);
  const simulator::World& world = sequence.world();
  CalibrationOptions options;
  options.camera = sequence.camera();
  options.noise.hand_rotation_rad = rad_from_deg(0.06);
  options.noise.hand_translation_mm = 0.15;
  Calibration calibration(options);
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  const auto normal3 = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  for (double time_s = -0.2; time_s < duration_s + 0.2; time_s += 1.0 / 60) {
    HandSample sample;
    sample.timestamp_ns = world.host_ns(time_s);
    sample.tracked = true;
    sample.room_from_hand = world.room_from_hand(time_s);
    sample.room_from_hand.linear() =
        sample.room_from_hand.linear() * exp_so3(options.noise.hand_rotation_rad * normal3());
    sample.room_from_hand.translation() += options.noise.hand_translation_mm * normal3();
    calibration.add_hand(sample);
  }
  TrackingStage stage({});
  SequenceFrame rendered;
  TrackedFrame tracked;
  while (sequence.next(rendered)) {
    Frame frame;
    frame.timestamp_ns = rendered.timestamp_ns;
    rendered.grey.copyTo(frame.grey);
    trouble(1e-9 * static_cast<double>(rendered.timestamp_ns - world.start_ns), frame.grey);
    for (int shown = 0; shown < times_shown; ++shown) {
      stage.process(frame, tracked);
      calibration.add_frame(tracked);
      frame.timestamp_ns += static_cast<std::int64_t>(
          1e9 / (sequence_options.camera_rate_hz * static_cast<double>(times_shown)));
    }
  }
  return {calibration.solve(), world.hand_from_eye};
}

bool in_the_middle(double time_s) {
  return time_s > 3.5 && time_s < 4.5;
}

void expect_right_or_refused(const Calibrated& calibrated, Reason reason) {
  const CalibrationResult& result = calibrated.result;
  if (result.verdict != Verdict::kAccepted) {
    EXPECT_EQ(result.reason, reason) << reason_word(result.reason);
    return;
  }
  const Pose& found = result.solution.hand_from_eye;
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found.linear(), calibrated.truth.linear())), 0.3);
  EXPECT_LT((found.translation() - calibrated.truth.translation()).norm(), 1.5);
}

TEST(ImageTrouble, ABlackSecondLeavesARightResult) {
  const Calibrated calibrated = calibrate(8, [](double time_s, cv::Mat& grey) {
    if (in_the_middle(time_s)) grey = cv::Scalar(3);
  });
  expect_right_or_refused(calibrated, Reason::kImageDark);
  EXPECT_NEAR(static_cast<double>(calibrated.result.frames.dark), 25, 1);
  EXPECT_LE(calibrated.result.frames.used, 176);
}

TEST(ImageTrouble, AFrozenSecondLeavesARightResult) {
  cv::Mat last;
  const Calibrated calibrated = calibrate(8, [&](double time_s, cv::Mat& grey) {
    if (in_the_middle(time_s)) last.copyTo(grey);
    grey.copyTo(last);
  });
  expect_right_or_refused(calibrated, Reason::kImageFrozen);
  EXPECT_NEAR(static_cast<double>(calibrated.result.frames.frozen), 25, 1);
  EXPECT_LE(calibrated.result.frames.used, 176);
}

TEST(ImageTrouble, AGrabberThreeTimesAsFastAsItsCameraDoesNoHarm) {
  const Calibrated calibrated = calibrate(
      8, [](double, cv::Mat&) {}, 3);
  const CalibrationResult& result = calibrated.result;
  EXPECT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
  expect_right_or_refused(calibrated, Reason::kNone);
  EXPECT_EQ(result.frames.received, 600);
  EXPECT_EQ(result.frames.frozen, 400);
  EXPECT_GT(result.frames.used, 180);
}

TEST(ImageTrouble, AFastGrabberIsNotBlamedForAScopeThatHardlyMoved) {
  const Calibrated calibrated = calibrate(
      0.6, [](double, cv::Mat&) {}, 3);
  EXPECT_EQ(calibrated.result.verdict, Verdict::kRefused);
  EXPECT_NE(calibrated.result.reason, Reason::kImageFrozen);
}

TEST(ImageTrouble, BlackOrFrozenAllAlongIsRefusedWithItsReason) {
  const Calibrated black = calibrate(3, [](double, cv::Mat& grey) { grey = cv::Scalar(0); });
  EXPECT_EQ(black.result.verdict, Verdict::kRefused);
  EXPECT_EQ(black.result.reason, Reason::kImageDark);
  EXPECT_FALSE(black.result.has_estimate);

  cv::Mat first;
  const Calibrated frozen = calibrate(3, [&](double, cv::Mat& grey) {
    if (first.empty()) first = grey.clone();
    first.copyTo(grey);
  });
  EXPECT_EQ(frozen.result.verdict, Verdict::kRefused);
  EXPECT_EQ(frozen.result.reason, Reason::kImageFrozen);
  EXPECT_FALSE(frozen.result.has_estimate);
  EXPECT_GT(frozen.result.frames.frozen, 70);
}

}  // namespace
}  // namespace handeye
