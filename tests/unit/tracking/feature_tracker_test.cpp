// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/feature_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

using test::MovingTexture;

constexpr std::int64_t kFrameNs = 40'000'000;
const cv::Size kSize(640, 480);

std::vector<TrackedFrame> track(const MovingTexture& texture, int frames, double light = 0.0,
                                const cv::Mat& mask = {}, const TrackerOptions& options = {}) {
  const auto tracker = make_feature_tracker(options);
  std::vector<TrackedFrame> tracked(static_cast<std::size_t>(frames));
  for (int f = 0; f < frames; ++f) {
    tracker->track(texture.image(f, light), mask, f * kFrameNs,
                   tracked[static_cast<std::size_t>(f)]);
  }
  return tracked;
}

/// Distances of the last frame's features from where they should be, given where each was found
/// first.
std::vector<double> drift_px(const MovingTexture& texture, const std::vector<TrackedFrame>& frames,
                             int min_age) {
  std::map<std::int64_t, std::pair<int, Eigen::Vector2d>> first;
  for (const TrackedFrame& frame : frames) {
    for (const Observation& seen : frame.observations) {
      first.try_emplace(seen.feature_id, static_cast<int>(frame.index), seen.pixel);
    }
  }
  const int last = static_cast<int>(frames.back().index);
  std::vector<double> drifts;
  for (const Observation& seen : frames.back().observations) {
    const auto& [born, pixel] = first.at(seen.feature_id);
    if (last - born < min_age) continue;
    drifts.push_back((texture.moved(pixel, born, last) - seen.pixel).norm());
  }
  std::sort(drifts.begin(), drifts.end());
  return drifts;
}

double quantile(const std::vector<double>& sorted, double fraction) {
  return sorted.at(static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1)));
}

TEST(FeatureTracker, FollowsATurningAndGrowingPictureWithoutDrift) {
  const MovingTexture texture(kSize);
  const auto drifts = drift_px(texture, track(texture, 60), 40);
  ASSERT_GT(drifts.size(), 100U);
  EXPECT_LT(quantile(drifts, 0.5), 0.1);
  EXPECT_LT(quantile(drifts, 0.9), 0.3);
}

TEST(FeatureTracker, IsNotDraggedByLightThatMovesWithTheCamera) {
  const MovingTexture texture(kSize);
  const auto drifts = drift_px(texture, track(texture, 60, 0.6), 40);
  ASSERT_GT(drifts.size(), 100U);
  EXPECT_LT(quantile(drifts, 0.5), 0.1);
  EXPECT_LT(quantile(drifts, 0.9), 0.3);
}

TEST(FeatureTracker, ReportsWideImagesInTheirOwnPixels) {
  const cv::Size wide(1920, 1080);
  const MovingTexture texture(wide);
  const auto drifts = drift_px(texture, track(texture, 12), 8);
  ASSERT_GT(drifts.size(), 100U);
  EXPECT_LT(quantile(drifts, 0.5), 0.15);
  EXPECT_LT(quantile(drifts, 0.9), 0.4);
}

TEST(FeatureTracker, OrdersIdsAndNeverBringsOneBack) {
  const MovingTexture texture(kSize);
  std::set<std::int64_t> gone;
  std::set<std::int64_t> before;
  for (const TrackedFrame& frame : track(texture, 60)) {
    EXPECT_TRUE(std::is_sorted(
        frame.observations.begin(), frame.observations.end(),
        [](const Observation& a, const Observation& b) { return a.feature_id < b.feature_id; }));
    std::set<std::int64_t> now;
    for (const Observation& seen : frame.observations) now.insert(seen.feature_id);
    EXPECT_EQ(now.size(), frame.observations.size());
    for (const std::int64_t id : now) EXPECT_FALSE(gone.contains(id)) << id;
    for (const std::int64_t id : before) {
      if (!now.contains(id)) gone.insert(id);
    }
    before = now;
  }
  EXPECT_FALSE(gone.empty());
}

TEST(FeatureTracker, KeepsTheLimitAndTheDistanceAndCountsFrames) {
  const MovingTexture texture(kSize);
  TrackerOptions options;
  options.max_features = 120;
  options.min_distance_px = 15;
  const auto frames = track(texture, 20, 0.0, {}, options);
  EXPECT_GT(frames.front().observations.size(), 90U);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(frames[f].index, static_cast<std::int64_t>(f));
    EXPECT_EQ(frames[f].timestamp_ns, static_cast<std::int64_t>(f) * kFrameNs);
    EXPECT_LE(frames[f].observations.size(), 120U);
  }
  const auto& found = frames.front().observations;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((found[i].pixel - found[j].pixel).norm(), 15.0);
  }
}

TEST(FeatureTracker, StaysWithinTheMask) {
  const MovingTexture texture(kSize);
  cv::Mat mask = cv::Mat::zeros(kSize, CV_8UC1);
  cv::circle(mask, {320, 240}, 180, 255, cv::FILLED);
  for (const TrackedFrame& frame : track(texture, 30, 0.0, mask)) {
    EXPECT_GT(frame.observations.size(), 100U);
    for (const Observation& seen : frame.observations) {
      EXPECT_LT((seen.pixel - Eigen::Vector2d(320, 240)).norm(), 180.0);
    }
  }
}

TEST(FeatureTracker, StartsAnewAfterDarkness) {
  const MovingTexture texture(kSize);
  const auto tracker = make_feature_tracker();
  TrackedFrame tracked;
  tracker->track(texture.image(0), {}, 0, tracked);
  ASSERT_FALSE(tracked.observations.empty());
  const std::int64_t newest = tracked.observations.back().feature_id;
  tracker->track(cv::Mat::zeros(kSize, CV_8UC1), {}, kFrameNs, tracked);
  EXPECT_TRUE(tracked.observations.empty());
  tracker->track(texture.image(2), {}, 2 * kFrameNs, tracked);
  ASSERT_GT(tracked.observations.size(), 200U);
  EXPECT_GT(tracked.observations.front().feature_id, newest);
}

TEST(FeatureTracker, DoesNotDependOnThreads) {
  const MovingTexture texture(kSize);
  TrackerOptions alone;
  alone.threads = 1;
  TrackerOptions many;
  many.threads = 3;
  const auto one = track(texture, 15, 0.4, {}, alone);
  const auto three = track(texture, 15, 0.4, {}, many);
  for (std::size_t f = 0; f < one.size(); ++f) {
    ASSERT_EQ(one[f].observations.size(), three[f].observations.size());
    for (std::size_t i = 0; i < one[f].observations.size(); ++i) {
      EXPECT_EQ(one[f].observations[i].feature_id, three[f].observations[i].feature_id);
      EXPECT_EQ(one[f].observations[i].pixel, three[f].observations[i].pixel);
    }
  }
}

TEST(FeatureTracker, IsBitIdenticalFromRunToRun) {
  const MovingTexture texture(kSize);
  const auto first = track(texture, 15, 0.4);
  const auto second = track(texture, 15, 0.4);
  for (std::size_t f = 0; f < first.size(); ++f) {
    ASSERT_EQ(first[f].observations.size(), second[f].observations.size());
    for (std::size_t i = 0; i < first[f].observations.size(); ++i) {
      EXPECT_EQ(first[f].observations[i].feature_id, second[f].observations[i].feature_id);
      EXPECT_EQ(first[f].observations[i].pixel, second[f].observations[i].pixel);
    }
  }
}

TEST(FeatureTracker, RefusesOptionsOutOfRange) {
  const TrackerOptions wrong[] = {{.max_features = 0},     {.max_features = -5},
                                  {.pyramid_levels = 0},   {.pyramid_levels = 6},
                                  {.min_distance_px = -1}, {.threads = 0}};
  for (const TrackerOptions& options : wrong) {
    EXPECT_THROW(make_feature_tracker(options), std::invalid_argument);
  }
}

}  // namespace
}  // namespace handeye
