// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/vision_thread.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

using std::chrono::milliseconds;

const cv::Size kSize{160, 120};

/// A texture that slides under the camera; `interlaced`: the odd lines are half a frame later.
cv::Mat picture(int number, bool interlaced) {
  static const cv::Mat texture = [] {
    cv::Mat noise(kSize.height + 200, kSize.width + 200, CV_8UC1);
    cv::RNG random(4);
    random.fill(noise, cv::RNG::UNIFORM, 0, 255);
    cv::GaussianBlur(noise, noise, {}, 2.5);
    cv::normalize(noise, noise, 20, 230, cv::NORM_MINMAX);
    return noise;
  }();
  const int at = number % 160 < 80 ? number % 160 : 160 - number % 160;
  const auto shown = [&](int shift) { return texture({{at + shift, at / 2}, kSize}).clone(); };
  cv::Mat image = shown(0);
  if (!interlaced) return image;
  const cv::Mat later = shown(2);
  for (int y = 1; y < image.rows; y += 2) later.row(y).copyTo(image.row(y));
  return image;
}

/// A vision thread whose camera and solver the test plays. One frame circulates: when it is back,
/// the thread is done with it.
class Vision : public testing::Test {
 protected:
  void show(const cv::Mat& grey) {
    Frame* frame = wait_for_frame();
    frame->grey = grey;
    frame->timestamp_ns = 40'000'000 * ++shown_;
    frames_.commit(frame);
    spare_ = wait_for_frame();
  }
  void show(int count, bool interlaced) {
    for (int k = 0; k < count; ++k) show(picture(number_++, interlaced));
  }

  Frame* wait_for_frame() {
    if (spare_ != nullptr) return std::exchange(spare_, nullptr);
    Frame* frame = frames_.acquire();
    while (frame == nullptr) {
      std::this_thread::yield();
      frame = frames_.acquire();
    }
    return frame;
  }

  /// What the solver would get.
  std::vector<TrackedFrame> take_all() {
    std::vector<TrackedFrame> taken;
    while (TrackedItem* item = vision_.tracked().take(milliseconds(0))) {
      taken.push_back(item->frame);
      vision_.tracked().release(item);
    }
    return taken;
  }

  /// What the watch would get: the number of the tracking of each frame.
  std::vector<std::uint64_t> take_watched() {
    std::vector<std::uint64_t> taken;
    while (TrackedItem* item = vision_.watched().take(milliseconds(0))) {
      taken.push_back(item->calibration);
      vision_.watched().release(item);
    }
    return taken;
  }

  Bus bus_{"memq://"};
  Exchange<Frame> frames_{1};
  Frame* spare_{nullptr};
  std::int64_t shown_{0};
  int number_{0};
  VisionThread vision_{frames_,
                       bus_,
                       {.mask = {},
                        .frame_channel = {},
                        .tracked_in_flight = 64}};  // last: its thread uses the above
};

TEST_F(Vision, SaysInterlacedAsLongAsItIs) {
  vision_.start();
  vision_.begin_collecting({});
  show(12, true);
  EXPECT_EQ(vision_.picture(), ImageCondition::kInterlaced);
  vision_.end_collecting();
  show(40, true);
  EXPECT_EQ(vision_.picture(), ImageCondition::kInterlaced) << "though nobody looks for it";
  vision_.begin_collecting({});
  show(30, false);
  EXPECT_EQ(vision_.picture(), ImageCondition::kGood) << "another camera's calibration";
}

TEST_F(Vision, GoesOnWhateverTheCameraSends) {
  vision_.start();
  for (const bool collecting : {false, true}) {
    if (collecting) vision_.begin_collecting({});
    vision_.record_until(std::numeric_limits<std::int64_t>::max());
    for (int k = 0; k < 16; ++k) show(k % 2 == 0 ? cv::Mat() : cv::Mat::ones(kSize, CV_16UC1));
    EXPECT_EQ(vision_.picture(), ImageCondition::kUnusable);
    show(16, false);
    EXPECT_EQ(vision_.picture(), ImageCondition::kGood);
  }
  EXPECT_EQ(vision_.frames_collected(), 32);
}

TEST_F(Vision, TellsTheSolverLateWhatItHadNoRoomFor) {
  vision_.start();
  vision_.begin_collecting({});
  while (vision_.tracked().dropped() == 0) show(1, false);
  // Another scene: its features begin, and are described, while there is no room.
  for (int k = 0; k < 20; ++k) show(255 - picture(number_++, false));
  take_all();
  for (int k = 0; k < 2; ++k) show(255 - picture(number_++, false));
  const std::vector<TrackedFrame> later = take_all();
  ASSERT_EQ(later.size(), 2U);
  std::set<std::int64_t> described;
  for (const FeatureDescription& its : later.front().descriptions) {
    EXPECT_TRUE(described.insert(its.feature_id).second) << "told twice";
  }
  const std::vector<Observation>& seen = later.front().observations;
  EXPECT_GT(seen.size(), 20U);
  EXPECT_GT(2 * described.size(), seen.size());
  for (const std::int64_t id : described) {
    EXPECT_TRUE(std::ranges::binary_search(seen, id, {}, &Observation::feature_id));
  }
}

TEST_F(Vision, TracksForTheWatchOnlyWhileNothingIsCollected) {
  vision_.start();
  show(20, false);
  EXPECT_TRUE(take_watched().empty()) << "nobody watches";
  vision_.begin_watching({});
  show(20, false);
  const std::vector<std::uint64_t> before = take_watched();
  EXPECT_GE(before.size(), 3U);
  EXPECT_EQ(std::ranges::count(before, 1U), std::ssize(before)) << "one tracking";

  vision_.begin_collecting({});
  show(20, false);
  EXPECT_TRUE(take_watched().empty()) << "it ends at the first frame";
  EXPECT_EQ(take_all().size(), 20U) << "and every frame is collected";

  vision_.end_collecting();
  show(20, false);
  const std::vector<std::uint64_t> after = take_watched();
  EXPECT_GE(after.size(), 3U);
  EXPECT_EQ(std::ranges::count(after, 2U), std::ssize(after)) << "features are numbered anew";
}

TEST_F(Vision, CollectsEveryFrameThoughTheWatchTakesNone) {
  vision_.start();
  vision_.begin_watching({});
  while (vision_.watched().dropped() == 0) show(1, false);
  vision_.begin_collecting({});
  show(30, false);
  EXPECT_EQ(take_all().size(), 30U);
  EXPECT_EQ(vision_.tracked().dropped(), 0U);
}

}  // namespace
}  // namespace handeye
