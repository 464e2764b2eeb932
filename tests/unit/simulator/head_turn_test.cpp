// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/head_turn.hpp"

#include <gmock/gmock.h>

#include "drivers/simulator/world.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

constexpr double kLater_s = 20.0;

TEST(HeadTurn, IsReadFromItsSpelling) {
  EXPECT_EQ(parse_head_turn("10:5"), (HeadTurn{10, 5, HeadTurn::About::kRoll}));
  EXPECT_EQ(parse_head_turn("0:-1.5:tilt"), (HeadTurn{0, -1.5, HeadTurn::About::kTilt}));
  EXPECT_EQ(spelling(parse_head_turn("10:1:turn")), "10:1:turn");
  for (const char* const text : {"", "5", ":", "5:", ":5", "-1:5", "5:nan", "5:181",
                                 "5:1:", "5:1:pan", "5:1:roll:2", "5 :1"}) {
    EXPECT_THROW(parse_head_turn(text), UsageError) << text;
  }
}

TEST(HeadTurn, TurnsTheCameraAndLeavesTheScope) {
  const World still({.seed = 3}, 0);
  const World turned({.seed = 3, .head_turn = HeadTurn{10, 5, HeadTurn::About::kTilt}}, 0);
  for (double time_s = 0; time_s < kLater_s; time_s += 0.25) {
    EXPECT_TRUE(turned.room_from_hand(time_s).isApprox(still.room_from_hand(time_s), 0));
    EXPECT_TRUE((turned.room_from_hand(time_s) * turned.hand_from_eye_at(time_s))
                    .isApprox(turned.room_from_eye(time_s), 1e-12));
  }
  EXPECT_TRUE(turned.room_from_eye(9.99).isApprox(still.room_from_eye(9.99), 0));
  const Eigen::Vector3d w = log_so3(still.hand_from_eye.linear().transpose() *
                                    turned.hand_from_eye_at(kLater_s).linear());
  EXPECT_TRUE(w.isApprox(Eigen::Vector3d(rad_from_deg(5.0), 0, 0), 1e-9));
  EXPECT_EQ(turned.hand_from_eye_at(kLater_s).translation(), still.hand_from_eye.translation());
}

TEST(HeadTurn, TakesHalfASecondWithoutAJump) {
  const HeadTurn turn{1, 5, HeadTurn::About::kRoll};
  double last_deg = 0;
  for (double time_s = 0.9; time_s < 1.7; time_s += 0.01) {
    const double deg = deg_from_rad(
        rotation_angle_rad(old_eye_from_eye(turn, time_s).linear(), Eigen::Matrix3d::Identity()));
    EXPECT_GE(deg, last_deg - 1e-6);
    EXPECT_LT(deg, last_deg + 0.2);
    last_deg = deg;
  }
  EXPECT_NEAR(last_deg, 5.0, 1e-9);
}

}  // namespace
}  // namespace handeye::simulator
