// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/hand_path.hpp"

#include <gtest/gtest.h>

namespace handeye {
namespace {

HandSample sample_at(double time_s, const Eigen::Vector3d& w, const Eigen::Vector3d& t_mm) {
  HandSample sample;
  sample.timestamp_ns = static_cast<std::int64_t>(1e9 * time_s);
  sample.tracked = true;
  sample.room_from_hand.linear() = exp_so3(w);
  sample.room_from_hand.translation() = t_mm;
  return sample;
}

TEST(HandPath, MeasuresCoverageAgainstTheFirstPose) {
  HandPath path;
  EXPECT_EQ(path.second_axis_deg(), 0);
  path.add(sample_at(0, {0, 0, 0}, {0, 0, 0}));
  path.add(sample_at(1, {rad_from_deg(10), 0, 0}, {3, 4, 0}));
  EXPECT_NEAR(path.rotation_coverage_deg(), 10, 1e-9);
  EXPECT_NEAR(path.translation_coverage_mm(), 5, 1e-9);
  EXPECT_NEAR(path.second_axis_deg(), 0, 1e-6) << "one axis only";
  path.add(sample_at(2, {0, rad_from_deg(6), 0}, {0, 0, 0}));
  EXPECT_GT(path.second_axis_deg(), 3);
}

TEST(HandPath, ThinsAndSkipsHiddenSamples) {
  HandPath path;
  for (int k = 0; k < 60; ++k) path.add(sample_at(k / 60.0, {0, 0, 0}, {0, 0, 0}));
  EXPECT_LE(path.room_from_hand().size(), 10U);
  const std::size_t before = path.room_from_hand().size();
  HandSample hidden = sample_at(9, {1, 0, 0}, {99, 0, 0});
  hidden.tracked = false;
  path.add(hidden);
  EXPECT_EQ(path.room_from_hand().size(), before);
  EXPECT_EQ(path.translation_coverage_mm(), 0);
}

}  // namespace
}  // namespace handeye
