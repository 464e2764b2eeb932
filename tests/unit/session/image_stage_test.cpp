// SPDX-License-Identifier: BSD-3-Clause
// Whatever comes from a camera: an image stage goes on.
#include "daemon/session/image_stage.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "daemon/session/tracking_stage.hpp"

namespace handeye {
namespace {

/// Something to see, other at each `number`.
Frame frame_of(cv::Size size, int number) {
  Frame frame;
  frame.timestamp_ns = number;
  frame.grey.create(size, CV_8UC1);
  cv::RNG random(static_cast<std::uint64_t>(number) + 1);
  random.fill(frame.grey, cv::RNG::UNIFORM, 40, 220);
  return frame;
}

/// Throws half way at its second image, as OpenCV does.
class ThrowingStage final : public ImageStage {
  void look(const cv::Mat& /*grey*/, std::int64_t /*timestamp_ns*/,
            TrackedFrame& tracked) override {
    tracked.observations.assign(2, {7, {1, 2}});
    tracked.descriptions.resize(1);
    if (++looks_ == 2) CV_Error(cv::Error::StsBadArg, "no such size");
  }
  int looks_{0};
};

TEST(ImageStage, GoesOnAfterAnImageThatIsThrownAt) {
  ThrowingStage stage;
  TrackedFrame tracked;
  for (int number = 0; number < 4; ++number) {
    stage.process(frame_of({64, 48}, number), tracked);
    const bool failed = number == 1;
    EXPECT_EQ(tracked.condition == ImageCondition::kUnusable, failed) << number;
    EXPECT_EQ(tracked.observations.size(), failed ? 0U : 2U) << number;
    EXPECT_EQ(tracked.descriptions.empty(), failed) << number;
    EXPECT_EQ(tracked.index, number);
    EXPECT_EQ(tracked.timestamp_ns, number);
  }
  EXPECT_EQ(stage.failures(), 1);
  EXPECT_EQ(stage.failure(), "no such size");
}

TEST(ImageStage, TellsUnusableImagesFromDarkOnes) {
  TrackingStage stage({});
  TrackedFrame tracked;
  for (const int type : {CV_8UC3, CV_16UC1, CV_32FC1}) {
    Frame frame;
    frame.grey = cv::Mat::zeros(48, 64, type);
    stage.process(frame, tracked);
    EXPECT_EQ(tracked.condition, ImageCondition::kUnusable) << type;
  }
  stage.process({}, tracked);
  EXPECT_EQ(tracked.condition, ImageCondition::kUnusable);
  EXPECT_EQ(stage.failures(), 4);
  EXPECT_FALSE(stage.failure().empty());
}

// A mask that does not fit the images is what OpenCV throws at.
TEST(TrackingStage, GoesOnWithAMaskOfAnotherSize) {
  TrackingStage stage(cv::Mat(30, 40, CV_8UC1, cv::Scalar(255)));
  TrackedFrame tracked;
  for (int number = 0; number < 5; ++number) {
    EXPECT_NO_THROW(stage.process(frame_of({640, 480}, number), tracked));
    EXPECT_EQ(tracked.index, number);
  }
}

TEST(TrackingStage, TakesImagesOfAnySize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 500), cv::Size(17, 9)}) {
    TrackingStage stage({});
    TrackedFrame tracked;
    for (int number = 0; number < 5; ++number) {
      EXPECT_NO_THROW(stage.process(frame_of(size, number), tracked)) << size;
    }
  }
}

}  // namespace
}  // namespace handeye
