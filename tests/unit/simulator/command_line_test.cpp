// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/command_line.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

std::optional<CommandLine> parse(std::vector<std::string> words) {
  words.insert(words.begin(), "handeye-sim");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  return parse_command_line(static_cast<int>(pointers.size()), pointers.data());
}

TEST(CommandLine, TakesABoardForBothCommands) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "--board", "chessboard:9x6:4"},
        std::vector<std::string>{"record", "out", "--duration", "1", "--board",
                                 "chessboard:9x6:4"}}) {
    const auto line = parse(words);
    ASSERT_TRUE(line.has_value());
    ASSERT_TRUE(line->simulator.board.has_value());
    EXPECT_EQ(to_string(*line->simulator.board), "chessboard:9x6:4");
  }
  EXPECT_FALSE(parse({"run"})->simulator.board.has_value());
}

TEST(CommandLine, SaysWhatIsWrongWithABoard) {
  for (const char* const board : {"chessboard:9x6", "chessboard:9:4", "charuco:8x6:6:7:DICT_4X4_50",
                                  "charuco:8x6:6:4:DICT_9X9_9", "tablecloth", ""}) {
    try {
      parse({"run", "--board", board});
      ADD_FAILURE() << board;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("board"),
                                               testing::Not(testing::HasSubstr("\n"))));
    }
  }
}

TEST(CommandLine, TakesHowFarTheScopeMoves) {
  const auto line = parse({"run", "--amplitude", "4.5,10"});
  EXPECT_EQ(line->simulator.largest_turn_deg, 4.5);
  EXPECT_EQ(line->simulator.largest_shift_mm, 10.0);
  EXPECT_THROW(parse({"run", "--amplitude", "40,10"}), UsageError);
  EXPECT_THROW(parse({"run", "--amplitude", "4.5"}), UsageError);
}

TEST(CommandLine, TakesWhatMakesThePicturesHard) {
  const auto line = parse({"run", "--disturb", "flicker,missing", "--scene", "plane", "--lens",
                           "-0.3", "--image-noise", "4"});
  EXPECT_EQ(describe(line->simulator.disturbances), "flicker,missing");
  EXPECT_EQ(line->simulator.scene, SceneKind::kPlane);
  EXPECT_EQ(line->simulator.lens, (std::array<double, 2>{-0.3, 0.0}));
  EXPECT_EQ(line->simulator.image_noise_grey, 4.0);
  EXPECT_EQ(parse({"run", "--lens", "-0.3,0.1"})->simulator.lens,
            (std::array<double, 2>{-0.3, 0.1}));

  const auto plain = parse({"run"});
  EXPECT_EQ(describe(plain->simulator.disturbances), "none");
  EXPECT_EQ(plain->simulator.scene, SceneKind::kTissue);
  EXPECT_FALSE(plain->simulator.lens.has_value());
}

TEST(CommandLine, RefusesDisturbancesItDoesNotKnow) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run", "--disturb", "fog"},
           {"run", "--disturb", "flicker,fog"},
           {"run", "--scene", "moon"},
           {"run", "--scene", "plane", "--board", "chessboard:9x6:4"},
           {"run", "--lens", "-3"},
           {"run", "--lens", "-0.1,0.1,0.1"},
           {"run", "--image-noise", "-1"}}) {
    EXPECT_THROW(parse(words), UsageError) << words[2];
  }
}

TEST(CommandLine, TakesWhatGoesWrongWithTheDevices) {
  const SimulatorOptions options =
      parse({"run", "--tracker-disturb", "occlusion@8=1.5,lost", "--camera-disturb", "stall@3",
             "--midnight", "12", "--timestamps", "ts2", "--covariance", "--turn-head", "20:5"})
          ->simulator;
  EXPECT_EQ(spelling(options.tracker_faults), "occlusion@8=1.5,lost=0.08");
  EXPECT_EQ(spelling(options.camera_faults), "stall@3=0.5");
  EXPECT_EQ(options.midnight_s, 12.0);
  EXPECT_EQ(options.timestamps, Timestamps::kUnixTime);
  EXPECT_TRUE(options.covariance);
  EXPECT_EQ(options.head_turn, (HeadTurn{20, 5, HeadTurn::About::kRoll}));

  const SimulatorOptions usual = parse({"run"})->simulator;
  EXPECT_TRUE(usual.tracker_faults.empty() && usual.camera_faults.empty());
  EXPECT_FALSE(usual.midnight_s || usual.covariance || usual.head_turn);
  EXPECT_EQ(usual.timestamps, Timestamps::kSecondsOfDay);
}

TEST(CommandLine, RefusesFaultsItDoesNotKnow) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"run", "--tracker-disturb", "stall"},
                                             {"run", "--camera-disturb", "lost"},
                                             {"run", "--timestamps", "ts3"},
                                             {"run", "--midnight", "-1"},
                                             {"run", "--turn-head", "5"}}) {
    EXPECT_THROW(parse(words), UsageError) << words[1];
  }
}

TEST(CommandLine, PlaysAControllerWhereAsked) {
  EXPECT_FALSE(parse({"run"})->controller.has_value());
  const auto usual = parse({"run", "--controller"})->controller;
  ASSERT_TRUE(usual.has_value());
  EXPECT_EQ(usual->port, 50105);
  EXPECT_EQ(usual->bind_address, "127.0.0.1");
  EXPECT_FALSE(usual->fault.has_value());
  const auto other = parse({"run", "--controller", "--controller-port", "0", "--controller-address",
                            "0.0.0.0", "--controller-fault", "garbage"})
                         ->controller;
  EXPECT_EQ(other->port, 0);
  EXPECT_EQ(other->bind_address, "0.0.0.0");
  EXPECT_EQ(other->fault, ControllerFault::kGarbage);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run", "--controller-port", "1"},
           {"run", "--controller", "--controller-port", "65536"},
           {"run", "--controller", "--controller-fault", "sulk"},
           {"run", "--controller", "--controller-address", "x"},
           {"record", "out", "--duration", "1", "--controller"}}) {
    EXPECT_THROW(parse(words), UsageError) << words[1];
  }
}

TEST(CommandLine, DrawsAnotherSeedWhereNoneIsGiven) {
  EXPECT_EQ(parse({"run", "--seed", "12"})->simulator.seed, 12U);
  EXPECT_NE(parse({"run"})->simulator.seed, parse({"run"})->simulator.seed);
}

}  // namespace
}  // namespace handeye::simulator
