// SPDX-License-Identifier: BSD-3-Clause
// The program as a script sees it where no daemon is needed: help, mistakes, files, exit codes.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/client/program_run.hpp"

namespace handeye {
namespace {

using test::Finished;
using test::run_handeye;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

/// One line that names the program, nothing on stdout.
void expect_failure(const Finished& finished, int exit_code) {
  EXPECT_EQ(finished.exit_code, exit_code);
  EXPECT_THAT(finished.out, IsEmpty());
  EXPECT_THAT(finished.err, StartsWith("handeye: "));
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
}

TEST(CommandLine, EveryCommandHasAHelpText) {
  const std::string overview = run_handeye({"--help"}).out;
  for (const std::string command : {"calibrate", "status", "watch", "cancel", "pose", "record",
                                    "replay", "solve", "onestep", "compare", "tracker"}) {
    const Finished finished = run_handeye({command, "--help"});
    EXPECT_EQ(finished.exit_code, 0) << command;
    EXPECT_THAT(finished.out, HasSubstr("Usage: handeye " + command)) << command;
    EXPECT_THAT(finished.out, HasSubstr("--json")) << command;
    EXPECT_THAT(finished.err, IsEmpty()) << command;
    EXPECT_THAT(overview, HasSubstr("\n  " + command + " ")) << command;
  }
}

TEST(CommandLine, TellsItsVersion) {
  const Finished finished = run_handeye({"--version"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.out, StartsWith("handeye "));
}

TEST(CommandLine, MistakesAreOneLineAndExitCode1) {
  const std::vector<std::vector<std::string>> mistakes{
      {},
      {"calibrat"},
      {"--bogus"},
      {"calibrate", "--bogus"},
      {"calibrate", "--sigma", "0.3"},
      {"calibrate", "--sigma", "0.3,-1"},
      {"calibrate", "--sigma", "0.3,nan"},
      {"calibrate", "--sigma", "0.3,1.5mm"},
      {"calibrate", "--body", "-1"},
      {"calibrate", "--max-duration", "0"},
      {"status", "--prefix", "ROOM.*"},
      {"status", "--color", "pink"},
      {"replay"},
      {"tracker"},
      {"tracker", "strat"},
      {"tracker", "start", "--controller", "artcontroller"},
      {"tracker", "start", "--controller", "127.0.0.1", "--port", "0"},
      {"tracker", "start", "--controller", "127.0.0.1", "--timeout", "0"},
      {"tracker", "start", "--controller", "127.0.0.1", "--config", "handeyed.toml"},
      {"record"},
      {"compare", "only-one.json"},
      {"compare", "a.json", "b.json", "--max-rotation", "x"},
  };
  for (const auto& arguments : mistakes) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    const Finished finished = run_handeye(arguments);
    expect_failure(finished, 1);
    EXPECT_THAT(finished.err, EndsWith("--help')\n"));
  }
}

TEST(CommandLine, NamesTheCommandThatDoesNotExist) {
  EXPECT_THAT(run_handeye({"calibrat"}).err, HasSubstr("'calibrat'"));
}

TEST(CommandLine, AnLcmUrlThatCannotBeUsedIsExitCode2) {
  expect_failure(run_handeye({"status", "--lcm-url", "udpm://10.1.2.3:7667"}), 2);
}

TEST(CommandLine, MissingFilesAreExitCode2AndNamed) {
  const std::string missing = "no-such-folder/no-such-file";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"replay", missing},
        {"replay", missing + ".lcm"},
        {"compare", missing, missing},
        {"record", missing + ".lcm", "--camera", missing}}) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    const Finished finished = run_handeye(arguments);
    expect_failure(finished, 2);
    EXPECT_THAT(finished.err, HasSubstr(missing));
  }
}

class CompareCommand : public ::testing::Test {
 protected:
  /// 0.2 deg about z, 3-4-0 mm, 2 ms away from the truth.
  void SetUp() override {
    test::write_text(folder_ / "truth.json",
                     R"({"hand_from_eye":{"q_wxyz":[1,0,0,0],"t_mm":[10,20,300]},
                         "time_offset_s":0.020})");
    test::write_text(folder_ / "result.json",
                     R"({"verdict":"accepted","hand_from_eye":
                         {"q_wxyz":[0.9999984769132877,0,0,0.0017453283658983088],
                          "t_mm":[13,24,300]},"time_offset_s":0.018})");
  }

  Finished compare(std::vector<std::string> options) const {
    options.insert(options.begin(), {"compare", folder_ / "result.json", folder_ / "truth.json"});
    return run_handeye(options);
  }

  test::TemporaryFolder folder_;
};

TEST_F(CompareCommand, TellsTheErrors) {
  const Finished finished = compare({"--json"});
  EXPECT_EQ(finished.exit_code, 0);
  const auto json = nlohmann::json::parse(finished.out);
  EXPECT_NEAR(json.at("rotation_deg").get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(json.at("translation_mm").get<double>(), 5.0, 1e-12);
  EXPECT_NEAR(json.at("time_offset_ms").get<double>(), -2.0, 1e-9);
  const Finished text = compare({});
  EXPECT_THAT(text.out, HasSubstr("0.2000 deg"));
  EXPECT_THAT(text.out, HasSubstr("5.0000 mm"));
  EXPECT_THAT(text.out, HasSubstr("2.0000 ms"));
}

TEST_F(CompareCommand, LimitsDecideTheExitCode) {
  EXPECT_EQ(compare({"--max-rotation", "0.21", "--max-translation", "5.1"}).exit_code, 0);
  EXPECT_EQ(compare({"--max-rotation", "0.19", "--max-translation", "5.1"}).exit_code, 3);
  EXPECT_EQ(compare({"--max-rotation", "0.21", "--max-translation", "4.9"}).exit_code, 3);
  EXPECT_EQ(compare({"--max-time-offset", "2.1"}).exit_code, 0);
  EXPECT_EQ(compare({"--max-time-offset", "1.9"}).exit_code, 3);
}

TEST_F(CompareCommand, FilesWithoutAUsableEstimateAreExitCode2) {
  for (const std::string text :
       {"", "[]", "{}", R"({"hand_from_eye":null})", R"({"hand_from_eye":{"q_wxyz":[1,0,0,0]}})",
        R"({"hand_from_eye":{"q_wxyz":[0,0,0,0],"t_mm":[0,0,0]}})",
        R"({"hand_from_eye":{"q_wxyz":[1,0,0,"0"],"t_mm":[0,0,0]}})"}) {
    SCOPED_TRACE(text);
    test::write_text(folder_ / "result.json", text);
    const Finished finished = compare({});
    expect_failure(finished, 2);
    EXPECT_THAT(finished.err, HasSubstr("result.json"));
  }
}

}  // namespace
}  // namespace handeye
