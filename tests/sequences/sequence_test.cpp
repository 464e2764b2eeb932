// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sequences/sequence.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "protocol/exit_codes.hpp"

namespace handeye::sequences {
namespace {

TEST(Sequence, EveryNameIsThereOnceAndDrawsSomethingOfItsOwn) {
  EXPECT_EQ(must_have_names().size(), 8U);
  EXPECT_EQ(hard_names().size(), 7U);
  std::set<std::string_view> names(must_have_names().begin(), must_have_names().end());
  names.insert(hard_names().begin(), hard_names().end());
  EXPECT_EQ(names.size(), 15U);
  for (const std::string_view name : names) EXPECT_NO_THROW(simulator_options(name, {})) << name;
  EXPECT_THROW(simulator_options("sunny", {}), UsageError);
  EXPECT_EQ(simulator_options("distortion", {}).lens->at(0), -0.3);
  EXPECT_EQ(simulator_options("noise", {}).image_noise_grey, 4.0);
  EXPECT_EQ(simulator::describe(simulator_options("plain", {}).disturbances), "none");
  EXPECT_EQ(simulator::describe(simulator_options("missing_frames", {}).disturbances), "missing");
}

TEST(Sequence, SkipsMissingFramesAndKeepsTime) {
  SequenceOptions options;
  options.duration_s = 3;
  options.width = 64;
  options.height = 48;
  Sequence sequence("missing_frames", options);
  SequenceFrame frame;
  int frames = 0;
  std::int64_t first_ns = 0;
  while (sequence.next(frame)) {
    if (frames++ == 0) first_ns = frame.timestamp_ns - std::int64_t{frame.number} * 40'000'000;
    EXPECT_EQ(frame.timestamp_ns, first_ns + std::int64_t{frame.number} * 40'000'000);
    EXPECT_TRUE(sequence.scene_from_eye(frame.timestamp_ns).isApprox(frame.scene_from_eye, 1e-6));
  }
  EXPECT_EQ(sequence.frames(), 75U);
  EXPECT_LT(frames, 72);
  EXPECT_GT(frames, 64);
}

TEST(Sequence, BeginsAgainWithTheSameBytes) {
  SequenceOptions options;
  options.duration_s = 0.2;
  Sequence sequence("bare", options);
  SequenceFrame first;
  SequenceFrame again;
  ASSERT_TRUE(sequence.next(first));
  ASSERT_TRUE(sequence.next(again));
  EXPECT_GT(cv::norm(first.grey, again.grey, cv::NORM_INF), 0.0);
  sequence.rewind();
  ASSERT_TRUE(sequence.next(again));
  EXPECT_EQ(cv::norm(first.grey, again.grey, cv::NORM_INF), 0.0);
}

TEST(TruePixel, GoesThereAndBack) {
  SequenceOptions options;
  options.duration_s = 1;
  Sequence sequence("bare", options);
  SequenceFrame first;
  SequenceFrame last;
  ASSERT_TRUE(sequence.next(first));
  const cv::Mat1f first_depth_mm = first.depth_mm.clone();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sequence.next(last));
  int moved = 0;
  for (int row = 10; row < 480; row += 40) {
    for (int column = 10; column < 640; column += 40) {
      const Eigen::Vector2d pixel(column + 0.3, row + 0.6);
      const auto seen = true_pixel(sequence.camera(), first_depth_mm, first.scene_from_eye, pixel,
                                   last.scene_from_eye);
      if (!seen) continue;
      moved += static_cast<int>((*seen - pixel).norm() > 5);
      const auto back = true_pixel(sequence.camera(), last.depth_mm, last.scene_from_eye, *seen,
                                   first.scene_from_eye);
      if (back) {
        EXPECT_LT((*back - pixel).norm(), 0.01);
      }
    }
  }
  EXPECT_GT(moved, 50);
  EXPECT_FALSE(true_pixel(sequence.camera(), first_depth_mm, first.scene_from_eye, {-1, 20},
                          last.scene_from_eye)
                   .has_value());
}

}  // namespace
}  // namespace handeye::sequences
