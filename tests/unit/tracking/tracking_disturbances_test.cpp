// SPDX-License-Identifier: BSD-3-Clause
// What features survive: blur, noise, missing frames, roll and zoom, a mask that moves.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/tracking/feature_tracker.hpp"
#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

using test::MovingTexture;

constexpr std::int64_t kFrameNs = 40'000'000;
const cv::Size kSize(640, 480);

double quantile(const std::vector<double>& sorted, double fraction) {
  return sorted.at(static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1)));
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

TEST(TrackingThrough, Blur) {
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

TEST(TrackingThrough, Noise) {
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

TEST(TrackingThrough, MissingFrames) {
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
TEST(TrackingThrough, RollAndZoom) {
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

TEST(TrackingThrough, AMaskThatMoves) {
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

}  // namespace
}  // namespace handeye
