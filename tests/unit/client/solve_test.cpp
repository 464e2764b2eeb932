// SPDX-License-Identifier: BSD-3-Clause
// `handeye solve` as people and scripts see it: text, JSON, the table of methods, mistakes.
#include <cstdlib>
#include <filesystem>
#include <sys/wait.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "client/cli/methods_table.hpp"
#include "client/cli/solve_json.hpp"
#include "client/cli/solve_text.hpp"
#include "daemon/handeye/types.hpp"
#include "drivers/recording/pose_file.hpp"
#include "tests/unit/client/program_run.hpp"

namespace handeye::cli {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const Palette kPlain(false);

PoseSolution accepted_solution() {
  PoseSolution solution{.scale = ScaleMode::kUnknown, .poses = 42, .poses_used = 39};
  solution.wrong_poses = {6, 11, 29};
  solution.noise = {rad_from_deg(0.05), 0.15, rad_from_deg(0.02), 1e-5};
  CalibrationResult& result = solution.calibration;
  result.verdict = Verdict::kAccepted;
  result.has_estimate = true;
  result.solution.hand_from_eye =
      make_pose(Eigen::Quaterniond(-0.5, -0.5, -0.5, -0.5), {1.25, -2.5, 301.125});
  result.solution.scale_units_per_mm = 0.0125;
  result.sigma_rotation_deg = 0.081;
  result.sigma_translation_mm = 0.442;
  result.residuals = {0.12, 1.5, 2.5, 2.25};
  result.methods = {{"andreff", result.solution, {0.12, 1.5, 2.5, 2.25}, 3.75, {}},
                    {"daniilidis", {}, {}, 0.5, {}},
                    {"maximum_likelihood", result.solution, {0.1, 1, 2, 3}, 4, {{0.081, 0.442}}}};
  return solution;
}

TEST(SolveText, ShowsVerdictEstimateAndTheMethodsSideBySide) {
  const std::string text = solve_text(accepted_solution(), kPlain);
  EXPECT_THAT(text, StartsWith("ACCEPTED  42 poses, 39 used, scale unknown\n"));
  EXPECT_THAT(text, HasSubstr("3 of 42 poses disagree with the others and were left out: "
                              "rows 7, 12, 30\n"));
  EXPECT_THAT(text, HasSubstr("x 1.250  y -2.500  z 301.125 mm"));
  EXPECT_THAT(text, HasSubstr("0.0125 units per mm"));
  EXPECT_THAT(text, HasSubstr("0.442 mm (wanted 1.5)"));
  EXPECT_THAT(text, HasSubstr("hand 0.05 deg 0.15 mm, eye 0.02 deg <0.001 mm, estimated"));
  EXPECT_THAT(text, ContainsRegex("method +translation % +rotation deg +rotation % +time ms +"
                                  "sigma deg +sigma mm\n"));
  EXPECT_THAT(text, ContainsRegex("andreff +2\\.5 +0\\.12 +1\\.5 +3\\.75\n"));
  EXPECT_THAT(text, ContainsRegex("daniilidis +no solution\n"));
  EXPECT_THAT(text, ContainsRegex("maximum_likelihood +2 +0\\.1 +1 +4\\.00 +0\\.081 +0\\.442\n"));
  EXPECT_THAT(text, ContainsRegex("andreff +1\\.250 +-2\\.500 +301\\.125 .* 0\\.0125\n"));
}

TEST(SolveText, ARefusalSaysWhyAndMarksTheEstimate) {
  PoseSolution solution = accepted_solution();
  solution.calibration.verdict = Verdict::kRefused;
  solution.calibration.reason = Reason::kFixedPoint;
  solution.calibration.advice = reason_advice(Reason::kFixedPoint);
  const std::string text = solve_text(solution, kPlain);
  EXPECT_THAT(text, StartsWith("REFUSED: fixed_point"));
  EXPECT_THAT(text, HasSubstr("slide it in and out"));
  EXPECT_LT(text.find("must not be used"), text.find("hand_from_eye"));
}

TEST(SolveText, TellsByHowMuchTheResidualsExceedTheNoiseGiven) {
  PoseSolution solution = accepted_solution();
  solution.noise_estimated = false;
  EXPECT_THAT(solve_text(solution, kPlain), Not(HasSubstr("times as much")));
  solution.noise_factor = 2.5;
  EXPECT_THAT(solve_text(solution, kPlain), HasSubstr("the residuals show 2.5 times as much"));
}

TEST(SolveText, HasNoTableOfPosesWhereNothingHasASolution) {
  PoseSolution solution{.poses = 2};
  solution.calibration.methods = {{"andreff", {}, {}, 0.5, {}}};
  const std::string text = solve_text(solution, kPlain);
  EXPECT_THAT(text, ContainsRegex("andreff +no solution\n"));
  EXPECT_THAT(text, Not(HasSubstr("units per mm")));
}

TEST(SolveText, KnownScaleIsNotShownAsAnEstimate) {
  PoseSolution solution = accepted_solution();
  solution.scale = ScaleMode::kKnown;
  solution.poses_used = 42;
  solution.wrong_poses = {};
  const std::string text = solve_text(solution, kPlain);
  EXPECT_THAT(text, StartsWith("ACCEPTED  42 poses, scale known\n"));
  EXPECT_THAT(text, AllOf(Not(HasSubstr("scale   ")), Not(HasSubstr("left out"))));
}

TEST(SolveJson, IsAResultWithNullWhereNothingWasSeen) {
  const auto json = solve_json(accepted_solution());
  EXPECT_EQ(json["verdict"], "accepted");
  EXPECT_EQ(json["hand_from_eye"]["t_mm"][2], 301.125);
  EXPECT_EQ(json["scale_units_per_mm"], 0.0125);
  EXPECT_EQ(json["scale"], "unknown");
  EXPECT_EQ(json["poses"]["received"], 42);
  EXPECT_EQ(json["poses"]["used"], 39);
  EXPECT_EQ(json["poses"]["wrong_rows"], (std::vector<int>{7, 12, 30}));
  EXPECT_NEAR(json["noise"]["hand"]["rotation_deg"], 0.05, 1e-12);
  EXPECT_EQ(json["noise"]["source"], "estimated");
  EXPECT_EQ(json["noise"]["exceeded_by"], 1.0);
  for (const char* field :
       {"request_id", "body_id", "eye", "camera", "frames", "features", "time_offset_s"}) {
    EXPECT_TRUE(json.at(field).is_null()) << field;
  }
  EXPECT_TRUE(json["residuals"].at("reprojection_px").is_null());
  EXPECT_EQ(json["residuals"]["translation_percent"], 2.5);
  ASSERT_EQ(json["methods"].size(), 3U);
  EXPECT_FALSE(json["methods"][0].contains("sigma"));
  EXPECT_TRUE(json["methods"][1]["hand_from_eye"].is_null());
  EXPECT_EQ(json["methods"][2]["sigma"]["translation_mm"], 0.442);
}

TEST(SolveJson, WithoutAnEstimateHasNoNumbersThatCouldBeMistakenForOne) {
  PoseSolution solution{.poses = 1};
  solution.calibration.reason = Reason::kNoMotion;
  const auto json = solve_json(solution);
  for (const char* field : {"hand_from_eye", "covariance", "sigma_rotation_deg", "residuals",
                            "scale_units_per_mm", "noise"}) {
    EXPECT_TRUE(json.at(field).is_null()) << field;
  }
}

TEST(MethodsTable, ListsEveryMethodOnceAScaleAndTheAnswerLast) {
  const std::string table = methods_table();
  for (const ScaleMode scale : {ScaleMode::kKnown, ScaleMode::kUnknown}) {
    for (const Method& method : methods(scale)) {
      const std::string name(method.name);
      const std::string where = scale == ScaleMode::kKnown ? "(known|both)" : "(unknown|both)";
      EXPECT_THAT(table, ContainsRegex(fmt::format("\n{} +{} +[A-Za-z]", name, where))) << name;
      EXPECT_THAT(method_names(), HasSubstr(name));
    }
  }
  EXPECT_THAT(table.substr(table.rfind('\n')), StartsWith("\nmaximum_likelihood "));
}

/// docs/methods.md shows the table between two markers: what the program prints, word by word.
TEST(MethodsTable, IsTheDocumentationsTable) {
  const std::string page = test::read_text(HANDEYE_SOURCE_DIR "/docs/methods.md");
  const std::string begin = "<!-- handeye solve --list-methods -->\n```text\n";
  const std::size_t from = page.find(begin);
  ASSERT_NE(from, std::string::npos);
  const std::size_t first = from + begin.size();
  const std::string shown = page.substr(first, page.find("\n```\n", first) - first);
  EXPECT_EQ(shown, methods_table()) << "put the output of handeye solve --list-methods there";
  for (const ScaleMode scale : {ScaleMode::kKnown, ScaleMode::kUnknown}) {
    for (const Method& method : methods(scale)) {
      EXPECT_THAT(page, HasSubstr(fmt::format("`{}`", method.name))) << "is not explained";
    }
  }
}

constexpr const char* kRow = "1,0,0,0,0,0,0,1,0,0,0,0,0,0\n";

class SolveCommand : public ::testing::Test {
 protected:
  std::string poses(const std::string& rows) const {
    test::write_text(folder_ / "poses.csv", std::string(kPoseFileHeader) + "\n" + rows);
    return folder_ / "poses.csv";
  }
  static void expect_one_line(const test::Finished& finished, int exit_code) {
    EXPECT_EQ(finished.exit_code, exit_code);
    EXPECT_EQ(finished.out, "");
    EXPECT_THAT(finished.err, StartsWith("handeye: "));
    EXPECT_EQ(finished.err.find('\n'), finished.err.size() - 1) << finished.err;
  }

  test::TemporaryFolder folder_;
};

TEST_F(SolveCommand, ListsTheMethodsWithoutAFile) {
  const test::Finished finished = test::run_handeye({"solve", "--list-methods"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, methods_table() + "\n");
  EXPECT_THAT(test::run_handeye({"solve", "--help"}).out, HasSubstr(method_names()));
}

TEST_F(SolveCommand, MistakesAreExitCode1) {
  const std::string file = poses(kRow);
  const std::vector<std::vector<std::string>> mistakes{
      {"solve"},
      {"solve", file, "--scale", "maybe"},
      {"solve", file, "--hand-noise", "0.1"},
      {"solve", file, "--eye-noise", "0.1,0"},
      {"solve", file, "--eye-noise", "1e-12,0.1"},
      {"solve", file, "--hand-noise", "0.1,1e9"},
      {"solve", file, "--sigma", "1;2"},
      {"solve", file, "another.csv"},
      {"solve", file, "--method", "newton"},
      {"solve", file, "--method", "tsai_lenz"},  // of known scale only
  };
  for (const auto& arguments : mistakes) {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    expect_one_line(test::run_handeye(arguments), 1);
  }
  EXPECT_THAT(test::run_handeye(mistakes.back()).err,
              AllOf(HasSubstr("'tsai_lenz' for --scale unknown"), HasSubstr("andreff")));
}

TEST_F(SolveCommand, FilesThatCannotBeUsedAreExitCode2AndNamed) {
  const test::Finished missing = test::run_handeye({"solve", folder_ / "none.csv"});
  expect_one_line(missing, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.csv"));
  const test::Finished damaged =
      test::run_handeye({"solve", poses("1,0,0,0,0,0,0,1,0,0,zero,0,0,0\n")});
  expect_one_line(damaged, 2);
  EXPECT_THAT(damaged.err, HasSubstr("poses.csv: line 2, column 11 (eye_qz): 'zero'"));
  const test::Finished empty = test::run_handeye({"solve", poses("")});
  expect_one_line(empty, 2);
  EXPECT_THAT(empty.err, HasSubstr("poses.csv: has no rows"));
}

TEST_F(SolveCommand, AResultThatCannotBePrintedIsExitCode2AndStillSaved) {
  const std::string saved = folder_ / "result.json";
  const std::string command =
      fmt::format("{} solve {} --save {}", HANDEYE_PROGRAM, poses(kRow), saved);
  for (const char* json : {"", " --json"}) {
    const int status = std::system((command + json + " >/dev/full 2>/dev/null").c_str());
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 2);
    EXPECT_EQ(nlohmann::json::parse(test::read_text(saved)).at("verdict"), "refused");
    std::filesystem::remove(saved);
  }
}

TEST_F(SolveCommand, TooFewPosesAreRefusedWithAReason) {
  const std::string row = kRow;
  for (const std::string& rows : {row, row + row, row + row + row}) {
    const test::Finished finished = test::run_handeye({"solve", poses(rows), "--json"});
    EXPECT_EQ(finished.exit_code, 3);
    EXPECT_EQ(nlohmann::json::parse(finished.out).at("reason"), "no_motion");
    EXPECT_EQ(finished.err, "");
  }
}

}  // namespace
}  // namespace handeye::cli
