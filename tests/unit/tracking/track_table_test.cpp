// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/track_table.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "daemon/tracking/motion_model.hpp"

namespace handeye {
namespace {

TEST(TrackTable, KeepsTheOrderAndItsAppearancesAsRowsGo) {
  TrackTable tracks(4);
  for (int i = 0; i < 4; ++i) tracks.add(10 + i, {static_cast<float>(i), 0}, 1);
  EXPECT_EQ(tracks.room(), 0U);
  const Appearance* last = &tracks.appearance_of(3);
  const Appearance* freed = &tracks.appearance_of(1);
  tracks.lost[1] = 1;
  tracks.drop_lost();
  EXPECT_EQ(tracks.id, (std::vector<std::int64_t>{10, 12, 13}));
  EXPECT_EQ(tracks.pixel[2].x(), 3.0F);
  EXPECT_EQ(&tracks.appearance_of(2), last);
  tracks.add(14, {9, 9}, 1);
  EXPECT_EQ(&tracks.appearance_of(3), freed);
  EXPECT_EQ(tracks.room(), 0U);
}

TEST(MotionModel, FindsTheMovementOfMostAndNoneOfFew) {
  Eigen::Matrix2f growth;
  growth << 0.02F, -0.05F, 0.05F, 0.02F;
  const Eigen::Vector2f shift(12, -7);
  std::vector<Eigen::Vector2f> from;
  std::vector<Eigen::Vector2f> to;
  for (int i = 0; i < 60; ++i) {
    from.emplace_back(static_cast<float>(37 * i % 640), static_cast<float>(71 * i % 480));
    to.push_back(from.back() + shift + growth * from.back());
    if (i % 5 == 0) to.back() += Eigen::Vector2f(60, -45);
  }
  std::vector<std::uint8_t> usable(from.size(), 1);
  MotionModel model;
  model.fit(from, to, usable);
  ASSERT_TRUE(model.known());
  for (std::size_t i = 1; i < from.size(); i += 5) {
    EXPECT_LT((model.moved(from[i]) - to[i]).norm(), 0.2F);
  }
  EXPECT_LT((model.linear() - Eigen::Matrix2f::Identity() - growth).norm(), 1e-3F);
  std::fill(usable.begin() + 7, usable.end(), 0);
  model.fit(from, to, usable);
  EXPECT_FALSE(model.known());
}

}  // namespace
}  // namespace handeye
