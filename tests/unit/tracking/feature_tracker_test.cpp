// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/feature_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

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

/// What a test does to the picture, and how the picture moves.
using Look = std::function<cv::Mat(const cv::Mat& image, int frame)>;

/// Quantiles of the errors of all features of the last frame that are old enough.
std::vector<double> drift_through(const MovingTexture& texture, const std::vector<int>& numbers,
                                  const Look& look, int min_age) {
  const auto tracker = make_feature_tracker();
  std::map<std::int64_t, std::pair<int, Eigen::Vector2d>> first;
  std::vector<double> drifts;
  for (const int number : numbers) {
    TrackedFrame tracked;
    tracker->track(look(texture.image(number), number), {}, number * kFrameNs, tracked);
    drifts.clear();
    for (const Observation& seen : tracked.observations) {
      first.try_emplace(seen.feature_id, number, seen.pixel);
      const auto& [born, pixel] = first.at(seen.feature_id);
      if (number - born < min_age) continue;
      drifts.push_back((texture.moved(pixel, born, number) - seen.pixel).norm());
    }
  }
  std::sort(drifts.begin(), drifts.end());
  return drifts;
}

std::vector<int> every_frame(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

TEST(FeatureTracker, SurvivesBlur) {
  const Look blurred = [](const cv::Mat& image, int frame) {
    cv::Mat soft;
    cv::GaussianBlur(image, soft, {}, 0.1 + 1.4 * std::abs(std::sin(0.3 * frame)));
    return soft;
  };
  const auto drifts = drift_through(MovingTexture(kSize), every_frame(40), blurred, 25);
  ASSERT_GT(drifts.size(), 100U);
  EXPECT_LT(quantile(drifts, 0.5), 0.1);
  EXPECT_LT(quantile(drifts, 0.9), 0.3);
}

TEST(FeatureTracker, SurvivesNoise) {
  const Look noisy = [](const cv::Mat& image, int frame) {
    cv::RNG random(static_cast<std::uint64_t>(frame) + 1);
    cv::Mat noise(image.size(), CV_16S);
    random.fill(noise, cv::RNG::NORMAL, 0, 4);
    cv::Mat sum;
    cv::add(image, noise, sum, cv::noArray(), CV_8U);
    return sum;
  };
  const auto drifts = drift_through(MovingTexture(kSize), every_frame(40), noisy, 25);
  ASSERT_GT(drifts.size(), 100U);
  EXPECT_LT(quantile(drifts, 0.5), 0.1);
  EXPECT_LT(quantile(drifts, 0.9), 0.2);
}

TEST(FeatureTracker, SurvivesMissingFrames) {
  std::vector<int> numbers;
  cv::RNG random(8);
  for (const int number : every_frame(60)) {
    if (random.uniform(0.0, 1.0) >= 0.08) numbers.push_back(number);
  }
  ASSERT_LT(numbers.size(), 58U);
  const Look plain = [](const cv::Mat& image, int) { return image; };
  const auto drifts = drift_through(MovingTexture(kSize), numbers, plain, 40);
  ASSERT_GT(drifts.size(), 100U);
  EXPECT_LT(quantile(drifts, 0.5), 0.1);
  EXPECT_LT(quantile(drifts, 0.9), 0.2);
}

/// Turned by up to 60 deg and grown to 1.5 times about the middle, in 60 frames.
TEST(FeatureTracker, SurvivesRollAndZoom) {
  const MovingTexture texture(kSize);
  const cv::Mat still = texture.image(0);
  const auto zoomed = [](int frame) {
    return cv::Mat(cv::getRotationMatrix2D({319.5F, 239.5F}, frame, 1.0 + 0.5 * frame / 60.0));
  };
  const auto tracker = make_feature_tracker();
  std::map<std::int64_t, Eigen::Vector2d> first;
  std::vector<double> drifts;
  for (int frame = 0; frame <= 60; ++frame) {
    cv::Mat image;
    cv::warpAffine(still, image, zoomed(frame), kSize, cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
    TrackedFrame tracked;
    tracker->track(image, {}, frame * kFrameNs, tracked);
    drifts.clear();
    for (const Observation& seen : tracked.observations) {
      if (frame == 0) first.emplace(seen.feature_id, seen.pixel);
      const auto origin = first.find(seen.feature_id);
      if (origin == first.end()) continue;
      const cv::Mat1d map = zoomed(frame);
      const Eigen::Vector2d& p = origin->second;
      const Eigen::Vector2d truth(map(0, 0) * p.x() + map(0, 1) * p.y() + map(0, 2),
                                  map(1, 0) * p.x() + map(1, 1) * p.y() + map(1, 2));
      drifts.push_back((truth - seen.pixel).norm());
    }
  }
  std::sort(drifts.begin(), drifts.end());
  // Of 300, those within some 160 px of the middle stay in view.
  ASSERT_GT(drifts.size(), 70U);
  EXPECT_LT(quantile(drifts, 0.5), 0.1);
  EXPECT_LT(quantile(drifts, 0.9), 0.3);
}

TEST(FeatureTracker, GoesOnBesideAMaskThatMoves) {
  const MovingTexture texture(kSize);
  const auto tracker = make_feature_tracker();
  std::map<std::int64_t, int> lives;
  for (int frame = 0; frame < 40; ++frame) {
    // A spot of light over the picture, and the mask over the spot.
    const cv::Point spot(100 + 11 * frame, 240);
    cv::Mat image = texture.image(frame);
    cv::Mat mask(kSize, CV_8UC1, cv::Scalar(255));
    cv::circle(image, spot, 20, 255, cv::FILLED);
    cv::circle(mask, spot, 24, 0, cv::FILLED);
    TrackedFrame tracked;
    tracker->track(image, mask, frame * kFrameNs, tracked);
    EXPECT_GT(tracked.observations.size(), 200U);
    for (const Observation& seen : tracked.observations) {
      ++lives[seen.feature_id];
      EXPECT_GT((seen.pixel - Eigen::Vector2d(spot.x, spot.y)).norm(), 23.0);
    }
  }
  const auto old =
      std::count_if(lives.begin(), lives.end(), [](const auto& life) { return life.second == 40; });
  EXPECT_GT(old, 120);
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

}  // namespace
}  // namespace handeye
