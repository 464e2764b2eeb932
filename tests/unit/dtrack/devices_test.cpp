// SPDX-License-Identifier: BSD-3-Clause
// Lines of devices: 6df2, 6df, 6dmt2, 6dmt, 6dmtr, 3d.
#include <gtest/gtest.h>

#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

const std::string kNowhere = "[0.000 0.000 0.000]" + kZeroMatrix;
const std::string kSomewhere = "[1.000 2.000 3.000]" + kMatrix;
const std::string kNoTipCovariance = "[0 0 0 0 0 0]";

TEST(DTrackFlystick, ButtonsStayValidWhileUntracked) {
  const Parsed parsed{"6df2 1 1 [0 -1.000 6 2]" + kNowhere + "[9 -1.00 1.00]"};
  ASSERT_EQ(parsed.frame.flysticks.size(), 1U);
  EXPECT_FALSE(parsed.frame.flysticks[0].tracked);
  EXPECT_TRUE(parsed.frame.flysticks[0].buttons[0]);
  EXPECT_TRUE(parsed.frame.flysticks[0].buttons[3]);
  EXPECT_EQ(parsed.frame.flysticks[0].joysticks, (std::vector<double>{-1, 1}));
}

TEST(DTrackFlystick, TrackedWithoutRotationIsDropped) {
  const Parsed parsed{"6df2 2 2 [0 1.000 6 2]" + kNowhere + "[9 -1.00 1.00] [1 1.000 6 2]" +
                      kSomewhere + "[1 0.00 0.00]"};
  EXPECT_EQ(parsed.status, ParseStatus::kPartial);
  ASSERT_EQ(parsed.frame.flysticks.size(), 1U);
  EXPECT_EQ(parsed.frame.flysticks[0].id, 1);
}

TEST(DTrackFlystick, MissingButtonWordOrJoystickRefusesTheLine) {
  for (const std::string inputs : {"[9 0.5]", "[9]", "[]", ""}) {
    const Parsed parsed{"6df2 1 1 [0 1.000 6 2]" + kSomewhere + inputs};
    EXPECT_EQ(parsed.counters().rejected_lines, 1U) << inputs;
    EXPECT_TRUE(parsed.frame.flysticks.empty()) << inputs;
  }
}

TEST(DTrackFlystick, OldDirections) {
  const auto joysticks = [](const std::string& word) {
    return Parsed{"6df 1 [0 -1.000 " + word + "]" + kPositionAndAngles + kZeroMatrix}
        .frame.flysticks.at(0)
        .joysticks;
  };
  EXPECT_EQ(joysticks("16"), (std::vector<double>{0, -1}));
  EXPECT_EQ(joysticks("32"), (std::vector<double>{-1, 0}));
  EXPECT_EQ(joysticks("64"), (std::vector<double>{0, 1}));
  EXPECT_EQ(joysticks("128"), (std::vector<double>{1, 0}));
  EXPECT_EQ(joysticks("192"), (std::vector<double>{1, 1}));
}

TEST(DTrackFlystick, OfBothFormatsTheLastWins) {
  const std::string old_line = "6df 1 [0 -1.000 1]" + kPositionAndAngles + kZeroMatrix;
  const std::string new_line = "6df2 1 1 [3 -1.000 6 2]" + kNowhere + "[9 0.00 0.00]";
  const Parsed new_last{"6dcal 4", old_line, new_line};
  EXPECT_EQ(new_last.counters()[WarningKind::kDuplicateLine], 1U);
  ASSERT_EQ(new_last.frame.flysticks.size(), 1U);
  EXPECT_EQ(new_last.frame.flysticks[0].id, 3);
  EXPECT_EQ(new_last.frame.calibrated_bodies, 4);
  const Parsed old_last{new_line, old_line, "6dcal 4"};
  EXPECT_EQ(old_last.frame.flysticks.at(0).id, 0);
  EXPECT_EQ(old_last.frame.calibrated_bodies, 3);
}

TEST(DTrackTool, DroppedOrRefused) {
  const Parsed dropped{"6dmt2 1 1 [0 1.000 4 2.000]" + kNowhere + "[3]" + kNoTipCovariance,
                       "6dmtr 1 1 [0 1.000]" + kNowhere};
  EXPECT_EQ(dropped.counters()[ErrorKind::kBadRotation], 2U);
  EXPECT_TRUE(dropped.frame.tools.empty());
  EXPECT_TRUE(dropped.frame.tool_references.empty());
  for (const std::string& line :
       {"6dmt2 1 1 [0 1.000 4 2.000]" + kSomewhere + "[]" + kNoTipCovariance,
        "6dmt2 1 1 [0 1.000 4 2.000]" + kSomewhere + "[3][0 0 0 0 0]",
        "6dmt2 1 1 [0 1.000 4]" + kSomewhere + "[3]" + kNoTipCovariance,
        "6dmt 1 [0 1.000]" + kSomewhere, "6dmtr 1 1 [0 1.000][1 2]" + kMatrix}) {
    const Parsed parsed{line};
    EXPECT_EQ(parsed.counters()[ErrorKind::kMissingValue], 1U) << line;
    EXPECT_TRUE(parsed.frame.tools.empty());
  }
}

TEST(DTrackTool, OldButtonsEndWithTheLastPressed) {
  const Parsed parsed{"6dmt 1 [0 1.000 5]" + kSomewhere, "6dcal 2"};
  ASSERT_EQ(parsed.frame.tools.size(), 1U);
  EXPECT_EQ(parsed.frame.tools[0].buttons, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(parsed.frame.calibrated_bodies, 1);
}

TEST(DTrackTool, UntrackedReferencesAndMarkersAreLeftOut) {
  const Parsed parsed{"6dmtr 2 1 [0 -1.000]" + kNowhere, "3d 1 [5 -1.000][0 0 0]"};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_TRUE(parsed.frame.tool_references.empty());
  EXPECT_TRUE(parsed.frame.markers.empty());
}

}  // namespace
}  // namespace handeye::dtrack
