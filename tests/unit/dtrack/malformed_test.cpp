// SPDX-License-Identifier: BSD-3-Clause
// What a parser must do with malformed input: one test for each case that has been seen to make
// other clients of this protocol mix lines, crash or publish nonsense.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

using namespace std::string_literals;

const std::string kMarkerLine = "3d 1 [1 1.000][55.125 -310.750 1210.000]";
const std::string kBodyLine = "6d 1 " + body("0");
const std::string kFlystickHead = "[0.000 0.000 0.000]" + kZeroMatrix;

/// The line between two good ones is refused for this reason; the good ones are read.
void expect_line_refused(const std::string& line, ErrorKind kind) {
  const Parsed parsed{"6dcal 7", line, kMarkerLine};
  EXPECT_EQ(parsed.status, ParseStatus::kPartial) << line;
  EXPECT_EQ(parsed.counters().rejected_lines, 1U) << line;
  EXPECT_EQ(parsed.counters()[kind], 1U) << line << ": not '" << name(kind) << "'";
  EXPECT_EQ(parsed.frame.calibrated_bodies, 7) << line;
  EXPECT_EQ(parsed.frame.markers.size(), 1U) << line;
  EXPECT_TRUE(parsed.frame.bodies.empty()) << line;
  EXPECT_TRUE(parsed.frame.covariances.empty()) << line;
  EXPECT_TRUE(parsed.frame.flysticks.empty()) << line;
  EXPECT_TRUE(parsed.frame.tools.empty()) << line;
  EXPECT_TRUE(parsed.frame.hands.empty()) << line;
  EXPECT_TRUE(parsed.frame.humans.empty()) << line;
  EXPECT_FALSE(parsed.frame.system_status.has_value()) << line;
}

void expect_datagram_refused(const std::string& text, ErrorKind kind) {
  const Parsed parsed(text);
  EXPECT_EQ(parsed.status, ParseStatus::kRejected) << text;
  EXPECT_EQ(parsed.counters()[kind], 1U) << text << ": not '" << name(kind) << "'";
  EXPECT_EQ(parsed.counters().rejected_datagrams, 1U);
  EXPECT_EQ(parsed.frame.number, 0U);
  EXPECT_TRUE(parsed.frame.bodies.empty()) << text;
  EXPECT_TRUE(parsed.frame.markers.empty()) << text;
}

TEST(DTrackMalformed, Row01_BodyLineCutShortFollowedByAnother) {
  const std::string flystick =
      "6df2 1 1 [0 1.000 4 2][1.500 2.250 3.750]" + kMatrix + "[1 0.0 0.0]";
  const Parsed parsed{"6d 2 " + body("0") + " [1 1.000]", flystick};
  EXPECT_EQ(parsed.status, ParseStatus::kPartial);
  EXPECT_EQ(parsed.counters().rejected_lines, 1U);
  EXPECT_TRUE(parsed.frame.bodies.empty());
  ASSERT_EQ(parsed.frame.flysticks.size(), 1U);
  EXPECT_EQ(parsed.frame.flysticks[0].room_from_body.translation(),
            Eigen::Vector3d(1.5, 2.25, 3.75));
}

TEST(DTrackMalformed, Row02_UnclosedBracket) {
  expect_line_refused("6d 1 [0 1.000" + kPositionAndAngles + kMatrix, ErrorKind::kUnclosedBlock);
  expect_line_refused("6d 1 [0 1.000]" + kPositionAndAngles + "[1 0 0 0 1 0 0 0 1",
                      ErrorKind::kUnclosedBlock);
  expect_line_refused("6d 1 [0 1.000 7" + kPositionAndAngles + kMatrix, ErrorKind::kUnclosedBlock);
  expect_line_refused("6d 1 [0 ", ErrorKind::kUnclosedBlock);
  expect_line_refused("6d 1 [0 [", ErrorKind::kUnclosedBlock);
}

TEST(DTrackMalformed, Row03_CountLargerThanTargets) {
  expect_line_refused("6d 2 " + body("0"), ErrorKind::kMissingTarget);
  expect_line_refused("6d 1", ErrorKind::kMissingTarget);
}

TEST(DTrackMalformed, Row04_CountSmallerThanTargetsWarns) {
  const Parsed parsed{"6d 1 " + body("0") + " " + body("1"), kMarkerLine};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.counters()[WarningKind::kSurplusTargets], 1U);
  ASSERT_EQ(parsed.frame.bodies.size(), 1U);
  EXPECT_EQ(parsed.frame.bodies[0].id, 0);
  EXPECT_EQ(parsed.frame.markers.size(), 1U);
}

TEST(DTrackMalformed, Row05_NoFinalLineEndReadsNothingBehindTheDatagram) {
  const std::string buffer = "fr 200\r\n6dcal 25\r\nfr 100\r\n6d 0\r\n";  // the rest is older
  const Parsed parsed(std::string_view(buffer).substr(0, 15));
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.frame.number, 200U);
  EXPECT_EQ(parsed.frame.calibrated_bodies, 2);
}

TEST(DTrackMalformed, Row06_EmptyCountDoesNotEatTheNextLine) {
  for (const std::string line : {"6dcal ", "6dcal"}) {
    const Parsed parsed{line, kBodyLine};
    EXPECT_EQ(parsed.status, ParseStatus::kPartial);
    EXPECT_EQ(parsed.counters()[ErrorKind::kMissingValue], 1U);
    EXPECT_FALSE(parsed.frame.calibrated_bodies.has_value());
    EXPECT_EQ(parsed.frame.bodies.size(), 1U);
  }
}

TEST(DTrackMalformed, Row07_NegativeId) {
  expect_line_refused("6d 1 " + body("-1"), ErrorKind::kBadId);
  expect_line_refused("6di 1 [-1 2 0.000][1.000 2.000 3.000]" + kMatrix, ErrorKind::kBadId);
  expect_line_refused("gl 1 [-1 1.000 0 3][1.0 2.0 3.0]" + kMatrix, ErrorKind::kBadId);
  expect_line_refused("6dcov 1 [-1 1.0 2.0 3.0][1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1]",
                      ErrorKind::kBadId);
}

TEST(DTrackMalformed, Row08_HugeIdsAndCounts) {
  expect_line_refused("6d 1 " + body("1000000000"), ErrorKind::kBadId);
  expect_line_refused("6d 1 " + body("100000"), ErrorKind::kBadId);
  expect_line_refused("6d 2000000000 " + body("0"), ErrorKind::kBadCount);
  expect_line_refused("6df2 2000000000 2000000000 ", ErrorKind::kBadCount);
  for (const std::string line :
       {"6dcal 2000000000", "3d 2000000000", "3d 1 [1000000000 1.000][1.000 2.000 3.000]"}) {
    const Parsed parsed{line};
    EXPECT_EQ(parsed.counters().rejected_lines, 1U) << line;
    EXPECT_FALSE(parsed.frame.calibrated_bodies.has_value());
    EXPECT_TRUE(parsed.frame.markers.empty());
  }
}

TEST(DTrackMalformed, Row09_NegativeCountInFlystickAndStatus) {
  expect_line_refused("6df2 1 -1 [0 1.000 4 2]", ErrorKind::kBadCount);
  expect_line_refused("6df2 1 1 [0 1.000 -4 2]" + kFlystickHead + "[0 0.0 0.0]",
                      ErrorKind::kBadCount);
  expect_line_refused("st 3 [0 3][2 2 5][1 5][0 1 0 0 7][2 -2 3]", ErrorKind::kBadCount);
}

TEST(DTrackMalformed, Row10_FewerDefinedThanListed) {
  expect_line_refused("6df2 0 1 [0 -1.000 0 0]" + kFlystickHead + "[]", ErrorKind::kBadCount);
  expect_line_refused("6dmtr 0 1 [0 1.000][1.000 2.000 3.000]" + kMatrix, ErrorKind::kBadCount);
}

TEST(DTrackMalformed, Row11_CovarianceOfAnUnlistedBodyIsIgnored) {
  const std::string covariances =
      "6dcov 2 [0 1.0 2.0 3.0][1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1]"
      " [7 1.0 2.0 3.0][1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1]";
  for (const Parsed& parsed : {Parsed{kBodyLine, covariances}, Parsed{covariances, kBodyLine}}) {
    EXPECT_EQ(parsed.status, ParseStatus::kComplete);
    EXPECT_EQ(parsed.counters()[WarningKind::kCovarianceWithoutBody], 1U);
    ASSERT_EQ(parsed.frame.covariances.size(), 1U);
    EXPECT_EQ(parsed.frame.covariances[0].id, 0);
  }
}

TEST(DTrackMalformed, Row12_HumanModelWithTooManyJointsOrNegativeIds) {
  std::string joints;
  for (int i = 0; i < 201; ++i) {
    joints += "[" + std::to_string(i) + " 1.000][1 2 3 0 0 0]" + kMatrix;
  }
  expect_line_refused("6dj 1 1 [0 201]" + joints, ErrorKind::kBadCount);
  expect_line_refused("6dj 1 1 [-1 0]", ErrorKind::kBadId);
  expect_line_refused("6dj 1 1 [0 1][-3 1.000][1 2 3 0 0 0]" + kMatrix, ErrorKind::kBadId);
  joints.resize(joints.rfind("[200 "));
  EXPECT_EQ(Parsed{"6dj 1 1 [0 200]" + joints}.frame.humans.at(0).joints.size(), 200U);
}

TEST(DTrackMalformed, Row13_IntegersThatWouldWrap) {
  expect_line_refused("6d 1 " + body("4294967296"), ErrorKind::kBadId);
  expect_line_refused("6d 4294967296 " + body("0"), ErrorKind::kBadCount);
  expect_datagram_refused("fr 4294967296\r\n" + kBodyLine, ErrorKind::kNoFrameNumber);
  expect_datagram_refused("fr -1\r\n" + kBodyLine, ErrorKind::kNoFrameNumber);
  EXPECT_EQ(Parsed("fr 4294967295\r\n"s).frame.number, 4294967295U);
}

TEST(DTrackMalformed, Row14_NumbersThatAreNone) {
  for (const std::string bad :
       {"nan",   "-nan", "inf", "-inf", "infinity", "0x1p3", "0x10", "1e",    "1e+", "1e-",
        "1e+-2", "1e5x", "e5",  "--1",  "+1",       "-",     ".",    "1.0.0", "1-2", "abc"}) {
    expect_line_refused("6d 1 " + body("0", bad), ErrorKind::kBadNumber);
  }
  expect_line_refused("6d 1 " + body("0", "1e999"), ErrorKind::kNumberOutOfRange);
  expect_line_refused("6d 1 " + body("0", "-1e999"), ErrorKind::kNumberOutOfRange);
  expect_line_refused("6d 1 " + body("0", std::string(400, '9')), ErrorKind::kNumberOutOfRange);
}

TEST(DTrackMalformed, Row15_DecimalComma) {
  expect_line_refused("6d 1 " + body("0", "1,000"), ErrorKind::kBadNumber);
  expect_line_refused("6d 1 [0 1.000][412,507 -88,250 1503,125 30,0 -20,0 45,0]" + kMatrix,
                      ErrorKind::kBadNumber);
  const Parsed parsed{"ts 43200,500000"};
  EXPECT_FALSE(parsed.frame.seconds_of_day.has_value());
  EXPECT_EQ(parsed.counters()[ErrorKind::kBadNumber], 1U);
}

TEST(DTrackMalformed, Row16_TrackedBodyWithoutRotationIsDroppedAlone) {
  const std::string reflection = "[1 0 0 0 1 0 0 0 -1]";
  const std::string stretched = "[1.0006 0 0 0 1 0 0 0 1]";
  const std::string skewed = "[1 0 0 0.0011 1 0 0 0 1]";
  for (const std::string& matrix : {kZeroMatrix, reflection, stretched, skewed}) {
    const Parsed parsed{"6d 2 [0 1.000]" + kPositionAndAngles + matrix + " " + body("1")};
    EXPECT_EQ(parsed.status, ParseStatus::kPartial) << matrix;
    EXPECT_EQ(parsed.counters().rejected_bodies, 1U) << matrix;
    EXPECT_EQ(parsed.counters()[ErrorKind::kBadRotation], 1U) << matrix;
    EXPECT_EQ(parsed.counters().rejected_lines, 0U) << matrix;
    ASSERT_EQ(parsed.frame.bodies.size(), 1U) << matrix;
    EXPECT_EQ(parsed.frame.bodies[0].id, 1) << matrix;
  }
  const Parsed good{"6d 1 [0 1.000]" + kPositionAndAngles + "[1 0 0 0.0009 1 0 0 0 1]"};
  ASSERT_EQ(good.frame.bodies.size(), 1U);
  const Eigen::Matrix3d rotation = good.frame.bodies[0].room_from_body.linear();
  EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-5);
}

TEST(DTrackMalformed, Row17_DuplicatesLastWins) {
  const std::string elsewhere = "[0 0.500][1.000 2.000 3.000 30.0000 -20.0000 45.0000]" + kMatrix;
  const Parsed twice_in_line{"6d 3 " + body("0") + " " + body("1") + " " + elsewhere};
  EXPECT_EQ(twice_in_line.status, ParseStatus::kComplete);
  EXPECT_EQ(twice_in_line.counters()[WarningKind::kDuplicateId], 1U);
  EXPECT_EQ(twice_in_line.frame.bodies.size(), 2U);
  ASSERT_NE(twice_in_line.frame.find_body(0), nullptr);
  EXPECT_EQ(twice_in_line.frame.find_body(0)->quality, 0.5);

  const Parsed line_twice{"6d 2 " + body("0") + " " + body("1"), "6d 1 " + elsewhere};
  EXPECT_EQ(line_twice.status, ParseStatus::kComplete);
  EXPECT_EQ(line_twice.counters()[WarningKind::kDuplicateLine], 1U);
  ASSERT_EQ(line_twice.frame.bodies.size(), 1U);
  EXPECT_EQ(line_twice.frame.bodies[0].quality, 0.5);

  const Parsed second_is_bad{"6d 2 " + body("0") + " " + body("1"), "6d 1 [0 1.000]"};
  EXPECT_EQ(second_is_bad.status, ParseStatus::kPartial);
  EXPECT_EQ(second_is_bad.frame.bodies.size(), 2U);
}

TEST(DTrackMalformed, Row18_EightOfNineMatrixValues) {
  expect_line_refused("6d 1 [0 1.000]" + kPositionAndAngles + "[1 0 0 0 1 0 0 0]",
                      ErrorKind::kMissingValue);
  expect_line_refused("6d 1 [0 1.000][1 2 3 0 0]" + kMatrix, ErrorKind::kMissingValue);
  expect_line_refused("6d 1 [0]" + kPositionAndAngles + kMatrix, ErrorKind::kMissingValue);
}

TEST(DTrackMalformed, Row19_ExtraValuesInABlockAreIgnored) {
  const Parsed parsed{"6d 1 [0 1.000 77 new][1 2 3 0 0 0 4.5][1 0 0 0 1 0 0 0 1 99]", kMarkerLine};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  ASSERT_EQ(parsed.frame.bodies.size(), 1U);
  EXPECT_EQ(parsed.frame.bodies[0].room_from_body.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(parsed.frame.bodies[0].room_from_body.linear().isIdentity(1e-12));
  EXPECT_EQ(parsed.frame.markers.size(), 1U);
}

TEST(DTrackMalformed, Row20_NothingIsCarriedOver) {
  Parser parser;
  Frame frame;
  ASSERT_EQ(parser.parse(sample("full_frame.txt"), frame), ParseStatus::kComplete);
  ASSERT_EQ(parser.parse("fr 2\r\n", frame), ParseStatus::kComplete);
  EXPECT_EQ(frame.number, 2U);
  EXPECT_FALSE(frame.seconds_of_day.has_value());
  EXPECT_FALSE(frame.unix_time.has_value());
  EXPECT_FALSE(frame.calibrated_bodies.has_value());
  EXPECT_FALSE(frame.calibrated_hands.has_value());
  EXPECT_TRUE(frame.bodies.empty());
  EXPECT_TRUE(frame.covariances.empty());
  EXPECT_TRUE(frame.flysticks.empty());
  EXPECT_TRUE(frame.tools.empty());
  EXPECT_TRUE(frame.tool_references.empty());
  EXPECT_TRUE(frame.markers.empty());
  EXPECT_TRUE(frame.hands.empty());
  EXPECT_TRUE(frame.humans.empty());
  EXPECT_FALSE(frame.system_status.has_value());
}

TEST(DTrackMalformed, Row21_BodyBeyondTheCalibratedCountIsPublished) {
  const Parsed parsed{"6dcal 1", "6d 1 " + body("5")};
  EXPECT_EQ(parsed.frame.calibrated_bodies, 1);
  ASSERT_EQ(parsed.frame.bodies.size(), 1U);
  EXPECT_EQ(parsed.frame.bodies[0].id, 5);
}

TEST(DTrackMalformed, Row22_CalibratedBodiesAreClampedAtZero) {
  const Parsed parsed{"6dcal 0", "6df 1 [0 1.000 33]" + kPositionAndAngles + kMatrix};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.frame.calibrated_bodies, 0);
  EXPECT_EQ(parsed.counters()[WarningKind::kCalibratedBelowZero], 1U);
}

TEST(DTrackMalformed, Row23_NegativeCounts) {
  expect_line_refused("6d -1", ErrorKind::kBadCount);
  expect_line_refused("6d -1 " + body("0"), ErrorKind::kBadCount);
  const Parsed parsed{"6dcal -3", "3d -3", "glcal -1", kBodyLine};
  EXPECT_EQ(parsed.counters()[ErrorKind::kBadCount], 3U);
  EXPECT_FALSE(parsed.frame.calibrated_bodies.has_value());
  EXPECT_FALSE(parsed.frame.calibrated_hands.has_value());
  EXPECT_TRUE(parsed.frame.markers.empty());
  EXPECT_EQ(parsed.frame.bodies.size(), 1U);
}

TEST(DTrackMalformed, Row24_ManyButtonsAndJoysticks) {
  const Parsed parsed{"6df2 1 1 [0 -1.000 40 9]" + kFlystickHead +
                      "[2147483649 129 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9]"};
  ASSERT_EQ(parsed.frame.flysticks.size(), 1U);
  const Flystick& flystick = parsed.frame.flysticks[0];
  ASSERT_EQ(flystick.buttons.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(flystick.buttons[i], i == 0 || i == 31 || i == 32 || i == 39) << i;
  }
  ASSERT_EQ(flystick.joysticks.size(), 9U);
  EXPECT_EQ(flystick.joysticks[8], 0.9);
  expect_line_refused("6df2 1 1 [0 -1.000 257 0]" + kFlystickHead + "[0 0 0 0 0 0 0 0 0]",
                      ErrorKind::kBadCount);
}

TEST(DTrackMalformed, Row25_DeviceIdsWithGapsAndOutOfOrder) {
  const Parsed parsed{
      "6df2 9 2 [7 -1.000 0 0]" + kFlystickHead + "[] [3 -1.000 0 0]" + kFlystickHead + "[]",
      "6dmt 2 [4 -1.000 0]" + kFlystickHead + " [1 -1.000 0]" + kFlystickHead, kBodyLine};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  ASSERT_EQ(parsed.frame.flysticks.size(), 2U);
  EXPECT_EQ(parsed.frame.flysticks[0].id, 7);
  EXPECT_EQ(parsed.frame.flysticks[1].id, 3);
  EXPECT_EQ(parsed.frame.tools.size(), 2U);
  EXPECT_EQ(parsed.frame.bodies.size(), 1U);
}

TEST(DTrackMalformed, Row26_HarmlessVariationsOfForm) {
  const std::string flystick = "6df2 1 1 [0 -1.000 0 0]" + kFlystickHead + "[]";
  for (const std::string end : {"\r\n", "\n", "\r", " \r\n", "\r\n\r\n\n", "\n\n"}) {
    for (const std::string& tail : {""s, "\0"s}) {
      const Parsed parsed("fr 1" + end + flystick + end + "gl 0 " + end + kBodyLine + end + tail);
      EXPECT_EQ(parsed.status, ParseStatus::kComplete);
      EXPECT_EQ(parsed.frame.flysticks.size(), 1U);
      EXPECT_EQ(parsed.frame.bodies.size(), 1U);
    }
  }
}

TEST(DTrackMalformed, Row27_NulInsideRefusesTheDatagram) {
  expect_datagram_refused("fr 1\r\n\0"s + kBodyLine + "\r\n", ErrorKind::kNulByte);
  expect_datagram_refused("fr 1\r\n" + kBodyLine + "\r\n\0\0"s, ErrorKind::kNulByte);
}

TEST(DTrackMalformed, Row28_NoFrameNumberFirst) {
  for (const std::string head :
       {"", "\r\n", "ts 1.0\r\n", " fr 1\r\n", "\tfr 1\r\n", "fr\t1\r\n", "FR 1\r\n", "fr\r\n",
        "fr 1 2\r\n", "fr x\r\n", "fr 1.5\r\n", "GET / HTTP/1.1\r\nHost: dtrack\r\n\r\n",
        "\x7f\x45LF\x02\xff\xfe\x80"}) {
    expect_datagram_refused(head + kBodyLine + "\r\n", ErrorKind::kNoFrameNumber);
  }
  expect_datagram_refused("\r\n", ErrorKind::kNoFrameNumber);
}

// Rows 29, 30 and 33 are the receiver's: receiver_test.cpp. Here is the parser's side of them.
TEST(DTrackMalformed, Row29_EmptyDatagram) {
  expect_datagram_refused("", ErrorKind::kNoFrameNumber);
  expect_datagram_refused("\0"s, ErrorKind::kNoFrameNumber);
}

TEST(DTrackMalformed, Row30_LargestDatagram) {
  std::string markers;
  int count = 0;
  for (; markers.size() < 65'400; ++count) {
    markers += " [" + std::to_string(count) + " 1.000][1.000 2.000 3.000]";
  }
  const std::string text = datagram({"3d " + std::to_string(count) + markers});
  ASSERT_GT(text.size(), 65'400U);
  const Parsed parsed(text);
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.frame.markers.size(), static_cast<std::size_t>(count));
}

TEST(DTrackMalformed, Row31_TwoFrameNumbers) {
  expect_datagram_refused("fr 1\r\n6d 0\r\nfr 2\r\n" + kBodyLine, ErrorKind::kSecondFrameNumber);
  expect_datagram_refused("fr 1\r\n" + kBodyLine + "\r\nfr", ErrorKind::kSecondFrameNumber);
}

TEST(DTrackMalformed, Row32_TimesOutOfRange) {
  for (const std::string line :
       {"ts2 1735732800 500000", "ts2 1735732800 1000000 4150", "ts2 -1 500000 4150",
        "ts2 1735732800 500000 4150 x", "ts -0.000001", "ts 86400.000000", "ts", "ts 1.0 2.0"}) {
    const Parsed parsed{line, kBodyLine};
    EXPECT_EQ(parsed.counters().rejected_lines, 1U) << line;
    EXPECT_FALSE(parsed.frame.unix_time.has_value()) << line;
    EXPECT_FALSE(parsed.frame.seconds_of_day.has_value()) << line;
    EXPECT_EQ(parsed.frame.bodies.size(), 1U) << line;
  }
  EXPECT_EQ(Parsed{"ts 86399.999999"}.frame.seconds_of_day, 86399.999999);
  EXPECT_EQ(Parsed{"ts 0.000000"}.frame.seconds_of_day, 0.0);
}

TEST(DTrackMalformed, Row33_EveryQueuedDatagramIsAFrameOfItsOwn) {
  Parser parser;
  Frame frame;
  for (std::uint32_t number = 1; number <= 200; ++number) {
    ASSERT_EQ(parser.parse("fr " + std::to_string(number) + "\r\n" + kBodyLine + "\r\n", frame),
              ParseStatus::kComplete);
    ASSERT_EQ(frame.number, number);
    ASSERT_EQ(frame.bodies.size(), 1U);
  }
  EXPECT_EQ(parser.counters().datagrams, 200U);
}

TEST(DTrackMalformed, UnknownLinesAreSkippedAndCounted) {
  const Parsed parsed{"6dnew 1 [0]", "averylongidentifier 1", "6D 0", "\t6d 0", kBodyLine};
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.counters()[WarningKind::kUnknownLine], 4U);
  EXPECT_EQ(parsed.frame.bodies.size(), 1U);
}

TEST(DTrackMalformed, TextBehindTheLastTarget) {
  expect_line_refused("6d 1 " + body("0") + " x", ErrorKind::kTrailingText);
  expect_line_refused("6d 2 " + body("0") + " x" + body("1"), ErrorKind::kTrailingText);
}

TEST(DTrackMalformed, EveryKindHasItsOwnName) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < kErrorKinds; ++i) names.push_back(name(static_cast<ErrorKind>(i)));
  for (std::size_t i = 0; i < kWarningKinds; ++i) {
    names.push_back(name(static_cast<WarningKind>(i)));
  }
  for (const std::string_view each : names) {
    EXPECT_EQ(std::ranges::count(names, each), 1) << each;
    EXPECT_FALSE(each.starts_with("unknown ") && !each.ends_with("type")) << each;
  }
}

}  // namespace
}  // namespace handeye::dtrack
