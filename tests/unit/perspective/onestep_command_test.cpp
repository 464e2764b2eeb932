// SPDX-License-Identifier: BSD-3-Clause
// `handeye onestep` as a script runs it.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/client/program_run.hpp"
#include "tests/unit/perspective/chung_simulation.hpp"
#include "tests/unit/perspective/onestep_files.hpp"

namespace handeye {
namespace {

using namespace test;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class OnestepCommand : public ::testing::Test {
 protected:
  OnestepCommand() : observations_(observations_json(chung::observe({}))) {}

  Finished run(const std::vector<std::string>& options = {"--json"}) {
    write_text(folder_ / "observations.json", observations_.dump());
    std::vector<std::string> words{"onestep", folder_ / "observations.json"};
    words.insert(words.end(), options.begin(), options.end());
    return run_handeye(words);
  }

  /// Unusable input: exit code 2, one line that names the file and the place.
  void expect_unusable(const std::string& place) {
    const Finished finished = run();
    EXPECT_EQ(finished.exit_code, 2) << finished.out;
    EXPECT_THAT(finished.out, IsEmpty());
    EXPECT_THAT(finished.err, HasSubstr("observations.json"));
    EXPECT_THAT(finished.err, HasSubstr(place));
    EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  }

  void expect_refused(const std::string& reason) {
    const Finished finished = run();
    EXPECT_EQ(finished.exit_code, 3) << finished.err;
    const json result = json::parse(finished.out);
    EXPECT_EQ(result.at("verdict"), "refused");
    EXPECT_EQ(result.at("reason"), reason);
    EXPECT_NE(result.at("advice"), "");
    EXPECT_TRUE(result.at("hand_from_eye").is_null());
  }

  TemporaryFolder folder_;
  json observations_;
};

/// Largest relative error of Y's Gibbs vector and translation.
double error_of(const json& object_from_hand) {
  chung::YVector y;
  for (int i = 0; i < 3; ++i) {
    y(i) = object_from_hand.at("gibbs").at(static_cast<std::size_t>(i)).get<double>();
    y(i + 3) = object_from_hand.at("t_mm").at(static_cast<std::size_t>(i)).get<double>();
  }
  const chung::YVector ideal = chung::y_vector(chung::object_from_hand());
  return (y - ideal).cwiseQuotient(ideal).cwiseAbs().maxCoeff();
}

TEST_F(OnestepCommand, AnswersThePapersSimulation) {
  const Finished finished = run();
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.err, IsEmpty());
  const json result = json::parse(finished.out);
  EXPECT_EQ(result.at("verdict"), "accepted");
  EXPECT_LT(error_of(result.at("object_from_hand")), 1e-6);
  EXPECT_LE(result.at("iterations").get<int>(), 6);
  EXPECT_LT(result.at("reprojection_px").get<double>(), 1e-6);
  const Pose hand_from_eye = chung::hand_from_eye();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(result.at("hand_from_eye").at("t_mm").at(static_cast<std::size_t>(i)).get<double>(),
                hand_from_eye.translation()(i), 1e-4);
  }
  const json& camera = result.at("camera");
  EXPECT_NEAR(camera.at("fx").get<double>() * chung::pixel_mm().x(), chung::kFocalLength_mm, 1e-6);
  EXPECT_NEAR(camera.at("fy").get<double>() * chung::pixel_mm().y(), chung::kFocalLength_mm, 1e-6);
  EXPECT_NEAR(camera.at("cx").get<double>(), 256.0, 1e-5);
  EXPECT_NEAR(camera.at("k1_per_mm2").get<double>() / chung::kK1_per_mm2, 1.0, 1e-6);
  EXPECT_FALSE(camera.contains("distortion"));
  for (const char* part : {"object_from_hand", "hand_from_eye", "camera"}) {
    EXPECT_TRUE(result.at("sigma").contains(part)) << part;
  }
}

TEST_F(OnestepCommand, StartsWhereItIsTold) {
  const json truth = json::parse(run().out);
  const auto solved_from = [&](const json& start) {
    write_text(folder_ / "start.json", start.dump());
    const Finished finished = run({"--json", "--start", folder_ / "start.json"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const json result = json::parse(finished.out);
    EXPECT_LT(error_of(result.at("object_from_hand")), 1e-6);
    EXPECT_LE(result.at("iterations").get<int>(), 6);
    return result.at("iterations").get<int>();
  };
  EXPECT_LE(solved_from(truth), 2);

  json start = truth;  // 75 % of rotation and translation
  start["object_from_hand"].erase("q_wxyz");
  for (const char* part : {"gibbs", "t_mm"}) {
    for (json& value : start["object_from_hand"][part]) value = 0.75 * value.get<double>();
  }
  EXPECT_GT(solved_from(start), 2);

  start = truth;  // 75 % of the distortion and the image centre
  for (const char* part : {"k1_per_mm2", "cx", "cy"}) {
    start["camera"][part] = 0.75 * start["camera"][part].get<double>();
  }
  EXPECT_GT(solved_from(start), 2);

  for (std::size_t row = 0; row < 3; ++row) {  // 90 % of each element of the matrices
    for (std::size_t column = 0; column < 4; ++column) {
      start = truth;
      for (json& matrix : start["perspective_matrices"]) {
        matrix[row][column] = 0.9 * matrix[row][column].get<double>();
      }
      solved_from(start);
    }
  }
}

TEST_F(OnestepCommand, WithoutDistortionTheLensStaysStraight) {
  const Finished finished = run({"--json", "--distortion", "none"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const json result = json::parse(finished.out);
  EXPECT_EQ(result.at("camera").at("k1_per_mm2"), 0.0);
  EXPECT_GT(error_of(result.at("matrix_method").at("object_from_hand")), 1e-3);
}

TEST_F(OnestepCommand, PrintsATableForPeople) {
  const Finished finished = run({});
  EXPECT_EQ(finished.exit_code, 0);
  for (const char* word : {"ACCEPTED", "hand_from_eye", "object_from_hand", "focal length", "k1",
                           "0.000432", "reprojection"}) {
    EXPECT_THAT(finished.out, HasSubstr(word));
  }
  EXPECT_THAT(finished.out, Not(HasSubstr("nan")));
}

TEST_F(OnestepCommand, UnusableNumbersAreExitCode2) {
  const json good = observations_;
  const auto with = [&](const char* pointer, const json& value) {
    observations_ = good;
    observations_[json::json_pointer(pointer)] = value;
  };
  with("/width", 0);
  expect_unusable("width");
  with("/pixel_mm", {0.1, -0.1});
  expect_unusable("pixel_mm");
  with("/positions", "none");
  expect_unusable("positions");
  with("/positions/1/hand1_from_hand/q_wxyz", {1, 1, 0, 0});
  expect_unusable("positions 2: hand1_from_hand: q_wxyz");
  with("/positions/1/hand1_from_hand/t_mm", {0, 0});
  expect_unusable("t_mm");
  with("/positions/0/hand1_from_hand/t_mm", {1, 0, 0});
  expect_unusable("positions 1");
  with("/positions/2/points/3", {1, 2, 3, 4});
  expect_unusable("positions 3: points 4");
  with("/positions/2/points/3/4", nullptr);  // what JSON makes of NaN
  expect_unusable("positions 3: points 4");
  with("/positions/2/points/3/0", "1");
  expect_unusable("positions 3: points 4");
  observations_ = json::array();
  expect_unusable("not a JSON object");
}

TEST_F(OnestepCommand, FilesThatAreNotThereAreExitCode2) {
  const Finished finished = run_handeye({"onestep", folder_ / "nothing.json"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, HasSubstr("nothing.json"));
  const Finished folder = run_handeye({"onestep", "."});
  EXPECT_EQ(folder.exit_code, 2);
  EXPECT_THAT(folder.err, HasSubstr(".: is a folder"));
}

TEST_F(OnestepCommand, WhatIsNullInAStartIsNotThere) {
  const auto from = [&](const json& start) {
    write_text(folder_ / "start.json", start.dump());
    return run({"--json", "--start", folder_ / "start.json"});
  };
  const Finished some = from({{"object_from_hand", nullptr},
                              {"camera", {{"cx", nullptr}, {"cy", nullptr}, {"k1_per_mm2", 0.0}}},
                              {"perspective_matrices", nullptr}});
  EXPECT_EQ(some.exit_code, 0) << some.err;
  const std::vector<json> unusable{json::object(),
                                   {{"object_from_hand", nullptr}, {"camera", nullptr}},
                                   {{"verdict", "refused"}},
                                   {{"camera", 5}},
                                   {{"object_from_hand", {1, 2, 3}}}};
  for (const json& start : unusable) {
    const Finished none = from(start);
    EXPECT_EQ(none.exit_code, 2) << start;
    EXPECT_THAT(none.err, HasSubstr("start.json: ")) << start;
    EXPECT_EQ(std::count(none.err.begin(), none.err.end(), '\n'), 1) << none.err;
  }
}

TEST_F(OnestepCommand, MistakesOnTheCommandLineAreExitCode1) {
  EXPECT_EQ(run_handeye({"onestep"}).exit_code, 1);
  EXPECT_EQ(run({"--distortion", "some"}).exit_code, 1);
}

TEST_F(OnestepCommand, DataThatDetermineNothingAreRefused) {
  const json good = observations_;
  observations_["positions"].erase(2);
  expect_refused("too_few_positions");
  observations_ = good;
  observations_["positions"] = json::array();
  expect_refused("too_few_positions");
  observations_ = good;
  json& points = observations_["positions"][1]["points"];
  points = json(points.begin(), points.begin() + 5);
  expect_refused("too_few_points");
  observations_ = good;
  for (std::size_t i = 1; i < 3; ++i) {
    observations_["positions"][i]["hand1_from_hand"]["q_wxyz"] = {1, 0, 0, 0};
  }
  expect_refused("insufficient_rotation");
  observations_ = good;
  observations_["positions"][2]["hand1_from_hand"] = good["positions"][1]["hand1_from_hand"];
  expect_refused("single_axis");
}

}  // namespace
}  // namespace handeye
