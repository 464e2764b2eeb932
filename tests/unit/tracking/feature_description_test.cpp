// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/feature_description.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/tracking/hamming_distance.hpp"
#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

constexpr int kFrames = 12;

/// Corners of the first image that follow the picture; `first_id` to tell two generations apart.
TrackedFrame features_at(const test::MovingTexture& texture, int frame, std::int64_t first_id) {
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(texture.image(0), corners, 150, 0.01, 20);
  TrackedFrame tracked;
  tracked.index = frame;
  for (const cv::Point2f& corner : corners) {
    tracked.observations.push_back({first_id++, texture.moved({corner.x, corner.y}, 0, frame)});
  }
  return tracked;
}

/// What a new describer says of these features, by their rank among the corners.
std::map<std::int64_t, FeatureDescription> described(const test::MovingTexture& texture, int from,
                                                     std::int64_t first_id) {
  FeatureDescriber describer;
  std::map<std::int64_t, FeatureDescription> found;
  for (int frame = from; frame < from + kFrames; ++frame) {
    TrackedFrame tracked = features_at(texture, frame, first_id);
    describer.describe(texture.image(frame), 1.0, tracked);
    for (const FeatureDescription& description : tracked.descriptions) {
      EXPECT_TRUE(found.emplace(description.feature_id - first_id, description).second)
          << "described twice";
    }
  }
  return found;
}

TEST(FeatureDescriber, RecognisesTheSameSpotLater) {
  const test::MovingTexture texture({640, 480});
  const auto first = described(texture, 0, 0);
  const auto later = described(texture, 40, 1000);
  ASSERT_GT(first.size(), 80U);
  int same = 0;
  int recognised = 0;
  int mistaken = 0;
  for (const auto& [place, description] : later) {
    if (!first.contains(place)) continue;
    ++same;
    const int distance = hamming_distance(first.at(place).bits, description.bits);
    if (distance < 64) ++recognised;
    for (const auto& [other, its] : first) {
      if (other != place && hamming_distance(its.bits, description.bits) <= distance) {
        ++mistaken;
        break;
      }
    }
  }
  ASSERT_GT(same, 60);
  // Turned by 13 degrees and an eighth larger, noise for a texture: half would do for a P3P.
  EXPECT_GT(recognised, 0.6 * same);
  EXPECT_LT(mistaken, 0.33 * same);
}

TEST(FeatureDescriber, DescribesNewFeaturesButNoneTwice) {
  const test::MovingTexture texture({640, 480});
  FeatureDescriber describer;
  std::set<std::int64_t> seen;
  for (int frame = 0; frame < 3 * kFrames; ++frame) {
    TrackedFrame tracked = features_at(texture, frame, 0);
    if (frame >= kFrames) {
      tracked.observations.push_back({5000, texture.moved({300.0, 250.0}, 0, frame)});
    }
    describer.describe(texture.image(frame), 1.0, tracked);
    for (const FeatureDescription& description : tracked.descriptions) {
      EXPECT_TRUE(seen.insert(description.feature_id).second) << description.feature_id;
    }
    if (frame == kFrames - 1) {
      EXPECT_FALSE(seen.contains(5000));
    }
  }
  EXPECT_TRUE(seen.contains(5000));
  EXPECT_GT(seen.size(), 80U);
}

TEST(FeatureDescriber, WaitsWithFeaturesWhosePatchIsCutOff) {
  const cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(90));
  FeatureDescriber describer;
  TrackedFrame tracked;
  tracked.observations = {{1, {3.0, 3.0}}, {2, {636.0, 200.0}}, {3, {320.0, 240.0}}};
  std::size_t described = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    describer.describe(grey, 1.0, tracked);
    for (const auto& description : tracked.descriptions) EXPECT_EQ(description.feature_id, 3);
    described += tracked.descriptions.size();
  }
  EXPECT_EQ(described, 1U);
}

TEST(FeatureDescriber, FindsTheFeaturesInAShrunkImage) {
  const test::MovingTexture texture({640, 480});
  FeatureDescriber describer;
  TrackedFrame tracked = features_at(texture, 0, 0);
  for (Observation& seen : tracked.observations) {
    seen.pixel = (seen.pixel.array() + 0.5) * 2.0 - 0.5;  // as in an image twice as large
  }
  std::map<std::int64_t, FeatureDescription> shrunk;
  for (int frame = 0; frame < kFrames; ++frame) {
    describer.describe(texture.image(0), 2.0, tracked);
    for (const auto& its : tracked.descriptions) shrunk.emplace(its.feature_id, its);
  }
  FeatureDescriber plain;
  tracked = features_at(texture, 0, 0);
  int compared = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    plain.describe(texture.image(0), 1.0, tracked);
    for (const auto& its : tracked.descriptions) {
      EXPECT_EQ(hamming_distance(its.bits, shrunk.at(its.feature_id).bits), 0);
      ++compared;
    }
  }
  EXPECT_GT(compared, 80);
}

}  // namespace
}  // namespace handeye
