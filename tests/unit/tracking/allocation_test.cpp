// SPDX-License-Identifier: BSD-3-Clause
// A program of its own, in which everything that is allocated is counted, by OpenCV too.
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/tracking/feature_tracker.hpp"
#include "tests/unit/counted_allocations.hpp"
#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

using test::allocations;
using test::counts_allocations;

constexpr std::int64_t kFrameNs = 40'000'000;
constexpr int kFirstFrames = 24;  ///< in which the memory is taken
constexpr int kFrames = 60;

/// What ORB allocates when it describes new features (every third frame at most, mostly every
/// eighth), 40 at most as measured: its own copies of image and key points, which its interface
/// gives no way to keep.
constexpr std::int64_t kMostForDescriptions = 60;

/// No mask, a spot, and one that leaves a third of the image, in turn.
cv::Mat mask_of(cv::Size size, int frame) {
  const int kind = frame / 3 % 4;
  if (kind == 0) return {};
  cv::Mat mask(size, CV_8UC1, cv::Scalar(255));
  const cv::Point middle(size.width / 3 + 4 * frame, size.height / 2);
  if (kind == 1) cv::circle(mask, middle, size.height / 20, 0, cv::FILLED);
  if (kind == 2) mask.rowRange(0, 2 * size.height / 3) = 0;
  return mask;
}

CameraModel lens_of(cv::Size size) {
  return {.width = size.width,
          .height = size.height,
          .fx = 0.9 * size.width,
          .fy = 0.9 * size.width,
          .cx = 0.5 * size.width,
          .cy = 0.5 * size.height,
          .distortion = {-0.3, 0, 0, 0, 0}};
}

class TrackerMemory : public testing::TestWithParam<cv::Size> {};

TEST_P(TrackerMemory, IsTakenAtTheStartAndKept) {
  if (!counts_allocations()) GTEST_SKIP() << "the sanitizer's allocator is in place";
  const cv::Size size = GetParam();
  cv::setNumThreads(1);  // OpenCV's own threads would hand out memory whenever they like
  const test::MovingTexture texture(size);
  const auto tracker = make_feature_tracker({.threads = 2, .lens = lens_of(size)});
  TrackedFrame tracked;
  int plain_frames = 0;
  std::size_t features = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const cv::Mat image = texture.image(frame);
    const cv::Mat mask = mask_of(size, frame);
    const std::int64_t before = allocations();
    tracker->track(image, mask, frame * kFrameNs, tracked);
    const std::int64_t count = allocations() - before;
    features += tracked.observations.size();
    if (frame < kFirstFrames) continue;
    if (tracked.descriptions.empty()) {
      ++plain_frames;
      EXPECT_EQ(count, 0) << "in frame " << frame;
    } else {
      EXPECT_LE(count, kMostForDescriptions) << "in frame " << frame;
    }
  }
  EXPECT_GT(allocations(), 1000);  // they are counted
  EXPECT_GT(plain_frames, (kFrames - kFirstFrames) / 2);
  EXPECT_GT(features / kFrames, 80U);
}

INSTANTIATE_TEST_SUITE_P(Sizes, TrackerMemory,
                         testing::Values(cv::Size(640, 480), cv::Size(1920, 1080)),
                         [](const auto& size) { return std::to_string(size.param.width); });

}  // namespace
}  // namespace handeye
