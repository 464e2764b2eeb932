// SPDX-License-Identifier: BSD-3-Clause
// Lines of people and of the system: gl, 6dj, st.
#include <gtest/gtest.h>

#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

const std::string kFinger = "[35.5 -40.2 -8.1]" + kMatrix + "[9.5 24.0 -18.0 31.5 -12.5 45.0]";

std::string hand(const std::string& head, int fingers) {
  std::string text = "[" + head + "][1.0 2.0 3.0]" + kMatrix;
  for (int i = 0; i < fingers; ++i) text += kFinger;
  return text;
}

TEST(DTrackHand, FiveFingersOfARightHand) {
  const Parsed parsed{"gl 1 " + hand("0 1.000 1 5", 5)};
  ASSERT_EQ(parsed.frame.hands.size(), 1U);
  EXPECT_TRUE(parsed.frame.hands[0].right);
  EXPECT_EQ(parsed.frame.hands[0].fingers.size(), 5U);
}

TEST(DTrackHand, FingerCountAndSideAreChecked) {
  for (const std::string& line :
       {"gl 1 " + hand("0 1.000 0 4", 4), "gl 1 " + hand("0 1.000 0 6", 6),
        "gl 1 " + hand("0 1.000 2 3", 3), "gl 1 " + hand("0 1.000 0 5", 3)}) {
    const Parsed parsed{line};
    EXPECT_EQ(parsed.status, ParseStatus::kPartial);
    EXPECT_EQ(parsed.counters().rejected_lines, 1U);
    EXPECT_TRUE(parsed.frame.hands.empty());
  }
}

TEST(DTrackHand, UntrackedIsLeftOut) {
  const Parsed parsed{"gl 2 " + hand("0 -1.000 0 3", 3) + " " + hand("1 1.000 0 3", 3)};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  ASSERT_EQ(parsed.frame.hands.size(), 1U);
  EXPECT_EQ(parsed.frame.hands[0].id, 1);
}

TEST(DTrackHand, AFingerWithoutRotationRefusesItsHandAlone) {
  const std::string bad_finger = "[35.5 -40.2 -8.1]" + kZeroMatrix + "[9.5 24 -18 31.5 -12.5 45]";
  const Parsed parsed{"gl 2 " + hand("0 1.000 0 3", 2) + bad_finger + " " + hand("1 1.000 1 3", 3)};
  EXPECT_EQ(parsed.status, ParseStatus::kPartial);
  EXPECT_EQ(parsed.counters().rejected_bodies, 1U);
  ASSERT_EQ(parsed.frame.hands.size(), 1U);
  EXPECT_EQ(parsed.frame.hands[0].id, 1);
}

TEST(DTrackHuman, UntrackedJointsStayListedAndBadOnesGo) {
  const Parsed parsed{"6dj 2 1 [4 3][0 -1.000][0 0 0 0 0 0]" + kZeroMatrix +
                      "[1 1.000][0 0 0 0 0 0]" + kZeroMatrix + "[2 1.000][1 2 3 0 0 0]" + kMatrix};
  EXPECT_EQ(parsed.status, ParseStatus::kPartial);
  ASSERT_EQ(parsed.frame.humans.size(), 1U);
  const auto& joints = parsed.frame.humans[0].joints;
  ASSERT_EQ(joints.size(), 2U);
  EXPECT_FALSE(joints[0].tracked);
  EXPECT_EQ(joints[1].id, 2);
  EXPECT_EQ(joints[1].room_from_joint.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(DTrackHuman, AJointCutShortRefusesTheLine) {
  const Parsed parsed{"6dj 1 1 [0 2][0 1.000][0 0 0 0 0 0]" + kMatrix + "[1 1.000][0 0"};
  EXPECT_EQ(parsed.counters()[ErrorKind::kUnclosedBlock], 1U);
  EXPECT_TRUE(parsed.frame.humans.empty());
}

TEST(DTrackStatus, GroupsMayCountTheCameraAndBeSpacedAndGrow) {
  const Parsed parsed{"st 4 [0 4] [2 2 5 9] [1 5] [0 1 0 0 7] [2 1 4] [3 8 6 7 1] [3 1] [x y] "};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  ASSERT_TRUE(parsed.frame.system_status.has_value());
  ASSERT_EQ(parsed.frame.system_status->camera_status.size(), 1U);
  EXPECT_EQ(parsed.frame.system_status->camera_status[0].id, 3);
}

TEST(DTrackStatus, FewerGroupsAreFine) {
  const Parsed parsed{"st 1 [0 3][2 4 6]"};
  ASSERT_TRUE(parsed.frame.system_status.has_value());
  EXPECT_EQ(parsed.frame.system_status->bodies, 4);
  EXPECT_TRUE(parsed.frame.system_status->camera_status.empty());
}

TEST(DTrackStatus, SurplusGroupsWarn) {
  const Parsed parsed{"st 1 [0 3][2 4 6][1 5][0 0 0 0 0]"};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.counters()[WarningKind::kSurplusTargets], 1U);
}

TEST(DTrackStatus, TwiceTheLastWins) {
  const Parsed parsed{"st 2 [0 3][2 4 6][2 1 3][0 1 1 1]", "st 1 [0 3][7 8 9]"};
  EXPECT_EQ(parsed.counters()[WarningKind::kDuplicateLine], 1U);
  ASSERT_TRUE(parsed.frame.system_status.has_value());
  EXPECT_EQ(parsed.frame.system_status->cameras, 7);
  EXPECT_TRUE(parsed.frame.system_status->camera_status.empty());
}

TEST(DTrackStatus, WhatIsIncompleteIsRefused) {
  for (const std::string line :
       {"st", "st -1", "st 1", "st 1 [0 2][2 4]", "st 1 [0 3][2 4]", "st 1 [0 3]",
        "st 1 [1 4][0 0 0 0]", "st 1 [1 5][0 0 0 0]", "st 1 [2 2 3][0 1 1 1]",
        "st 1 [2 1 2][0 1 1]", "st 1 [2 1 3][0 1 1]", "st 1 [2 1 3][0 1 -1 1]",
        "st 1 [0 3][2 4 6] x"}) {
    const Parsed parsed{line};
    EXPECT_EQ(parsed.counters().rejected_lines, 1U) << line;
    EXPECT_FALSE(parsed.frame.system_status.has_value()) << line;
  }
}

}  // namespace
}  // namespace handeye::dtrack
