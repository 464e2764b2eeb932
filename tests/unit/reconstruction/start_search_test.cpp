// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_search.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/geometry/projection.hpp"

namespace handeye {
namespace {

/// A pixel here is one at kReferenceFocalPx.
CameraModel camera_of_reference() {
  return {640, 480, kReferenceFocalPx, kReferenceFocalPx, 319.5, 239.5, {}};
}

/// Features that drift a pixel a frame, each in its own direction: no camera moves so.
std::vector<FrameRecord> drifting(int frames, std::int64_t first_id, unsigned seed) {
  constexpr std::int64_t kFeatures = 100;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> x(80, 560);
  std::uniform_real_distribution<float> y(80, 400);
  std::uniform_real_distribution<float> direction_rad(0, 2 * static_cast<float>(kPi));
  std::vector<FrameRecord> records(static_cast<std::size_t>(frames));
  for (std::int64_t id = first_id; id < first_id + kFeatures; ++id) {
    const float x0 = x(random);
    const float y0 = y(random);
    const float towards_rad = direction_rad(random);
    for (std::size_t f = 0; f < records.size(); ++f) {
      const auto drift_px = static_cast<float>(f);
      records[f].observations.push_back(
          {id, x0 + drift_px * std::cos(towards_rad), y0 + drift_px * std::sin(towards_rad)});
    }
  }
  return records;
}

/// How far apart the costly attempts are [frames, hence px].
std::vector<int> between_attempts(const std::vector<FrameRecord>& records) {
  const CameraModel camera = camera_of_reference();
  const ReconstructionOptions options;
  StartSearch search(camera, options);
  std::vector<FrameRecord> seen;
  std::vector<int> between;
  int last = -1;
  for (const FrameRecord& record : records) {
    seen.push_back(record);
    seen.back().index = std::ssize(seen) - 1;
    const StartAttempt attempt = search.look(seen);
    EXPECT_FALSE(attempt.scene);
    if (!attempt.costly) continue;
    const auto frame = static_cast<int>(seen.back().index);
    if (last >= 0) between.push_back(frame - last);
    last = frame;
  }
  return between;
}

TEST(StartSearch, WaitsLongerAfterEachRefusal) {
  const auto between = between_attempts(drifting(150, 0, 1));
  ASSERT_GE(between.size(), 5U);
  // A frame late at most, for the drift is of the order of rounding.
  const std::vector<int> wanted{4, 8, 16, 32, 32};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_GE(between[i], wanted[i]);
    EXPECT_LE(between[i], wanted[i] + 1);
  }
}

TEST(StartSearch, IsImpatientAgainInAnotherScene) {
  std::vector<FrameRecord> records = drifting(70, 0, 1);
  for (FrameRecord& record : drifting(40, 1000, 2)) records.push_back(std::move(record));
  const auto between = between_attempts(records);
  // 4, 8, 16, 32, then to the first attempt in the new scene, and from there.
  ASSERT_GE(between.size(), 7U);
  EXPECT_LE(between[4], 20);
  EXPECT_LE(between[5], 5);
  EXPECT_LE(between[6], 9);
  EXPECT_GE(between[6], 8);
}

}  // namespace
}  // namespace handeye
