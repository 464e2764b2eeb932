// SPDX-License-Identifier: BSD-3-Clause
// `handeye solve` from file to exit code: poses whose answer is known, poses that others measured,
// and files that cannot be used.
#include <cstdlib>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "daemon/geometry/pose.hpp"
#include "tests/system/pose_json.hpp"
#include "tests/system/process.hpp"

namespace handeye::test {
namespace {

using testing::HasSubstr;

constexpr const char* kHeader =
    "hand_qw,hand_qx,hand_qy,hand_qz,hand_x,hand_y,hand_z,"
    "eye_qw,eye_qx,eye_qy,eye_qz,eye_x,eye_y,eye_z\n";

std::string fields(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d& t = pose.translation();
  return fmt::format("{:.12g},{:.12g},{:.12g},{:.12g},{:.9g},{:.9g},{:.9g}", q.w(), q.x(), q.y(),
                     q.z(), t.x(), t.y(), t.z());
}

Pose turned_and_moved(const Eigen::Vector3d& turn, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(turn);
  pose.translation() = translation;
  return pose;
}

const Pose kHandFromEye = turned_and_moved({0.4, -1.9, 0.8}, {62, -25, 292});

/// Free movements round a scene, seen by a camera in units of `units_per_mm`; little noise.
std::string free_movements(int count, double units_per_mm) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  const auto random = [&](double sigma) {
    const double x = normal(generator);
    const double y = normal(generator);
    return Eigen::Vector3d(sigma * x, sigma * y, sigma * normal(generator));
  };
  const Pose room_from_scene = turned_and_moved({-0.7, 0.5, 1.2}, {350, -280, 860});
  std::string text = kHeader;
  for (int k = 0; k < count; ++k) {
    const Pose room_from_hand = turned_and_moved(random(0.4), random(60));
    Pose eye_from_scene =
        (room_from_hand * turned_and_moved(random(0.0005), random(0.05)) * kHandFromEye).inverse() *
        room_from_scene;
    eye_from_scene.translation() *= units_per_mm;
    text += fields(room_from_hand) + "," + fields(eye_from_scene) + "\n";
  }
  return text;
}

class SolveSystem : public testing::Test {
 protected:
  std::string file(const std::string& text) const {
    write_bytes(folder_ / "poses.csv", text);
    return folder_ / "poses.csv";
  }
  /// A set of the real poses; empty, and the test skipped, where they are not there.
  static std::string real_set(const std::string& name) {
    const char* configured = std::getenv("HANDEYE_DATA");
    const std::filesystem::path data =
        configured != nullptr ? configured : HANDEYE_SOURCE_DIR "/../shared/data";
    return data / "poses" / name;
  }
  static bool missing(const std::string& path) { return !std::filesystem::exists(path); }

  TemporaryFolder folder_;
};

TEST_F(SolveSystem, FindsTheKnownAnswerAndItsScale) {
  const std::string poses = file(free_movements(60, 0.02));
  const std::filesystem::path saved = folder_ / "result.json";
  const Finished finished = run({handeye(), "solve", poses, "--json", "--save", saved});
  ASSERT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  const nlohmann::json result = parse_json(finished.out);
  EXPECT_EQ(result.at("verdict"), "accepted");
  EXPECT_NEAR(result.at("scale_units_per_mm").get<double>(), 0.02, 2e-4);
  EXPECT_TRUE(near(pose_of(result.at("hand_from_eye")), kHandFromEye,
                   4 * result.at("sigma_rotation_deg").get<double>(),
                   4 * result.at("sigma_translation_mm").get<double>()));
  EXPECT_EQ(read_json(saved), result);

  const Finished known = run({handeye(), "solve", file(free_movements(60, 1)), "--scale", "known",
                              "--hand-noise", "0.03,0.05", "--eye-noise", "0.001,0.001"});
  EXPECT_EQ(known.exit_code, 0) << known.out << known.err;
  EXPECT_THAT(known.out, HasSubstr("ACCEPTED"));
  EXPECT_THAT(known.out, HasSubstr("given"));
}

TEST_F(SolveSystem, SaysTheSameEveryTime) {
  const std::string poses = file(free_movements(40, 0.02));
  const auto answer = [&] {
    nlohmann::json result = parse_json(run({handeye(), "solve", poses, "--json"}).out);
    result.erase("timings_ms");
    for (auto& method : result.at("methods")) method.erase("time_ms");
    return result;
  };
  EXPECT_EQ(answer(), answer());
}

TEST_F(SolveSystem, RefusesTheRealLaparoscopesFixedPointUnlessTheScaleIsKnown) {
  const std::string poses = real_set("laparoscope.csv");
  if (missing(poses)) GTEST_SKIP() << poses << " is not there: set HANDEYE_DATA";
  const Finished unknown = run({handeye(), "solve", poses, "--json"});
  EXPECT_EQ(unknown.exit_code, 3);
  const nlohmann::json refused = parse_json(unknown.out);
  EXPECT_EQ(refused.at("reason"), "fixed_point");
  EXPECT_THAT(refused.at("advice").get<std::string>(), HasSubstr("in and out"));
  EXPECT_TRUE(refused.at("hand_from_eye").is_object());

  const Finished known = run({handeye(), "solve", poses, "--scale", "known", "--json"});
  EXPECT_EQ(known.exit_code, 0) << known.out;
  const Pose hand_from_eye = pose_of(parse_json(known.out).at("hand_from_eye"));
  EXPECT_LT((hand_from_eye.translation() - Eigen::Vector3d(-27.9, 3.4, -275.6)).norm(), 1);
}

TEST_F(SolveSystem, NamesTheRowsThatAreWrong) {
  std::string text = free_movements(40, 1);
  std::size_t at = 0;
  for (int line = 0; line < 12; ++line) at = text.find('\n', at) + 1;
  const std::string stray = fields(turned_and_moved({1, 0, -1}, {900, 0, 0}));
  text.replace(at, text.find('\n', at) - at,
               stray + "," + fields(turned_and_moved({0, 2, 0}, {0, 70, 5})));
  const Finished finished = run({handeye(), "solve", file(text), "--json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  EXPECT_EQ(parse_json(finished.out).at("poses").at("wrong_rows"), nlohmann::json({12}));
}

TEST_F(SolveSystem, FilesThatCannotBeUsed) {
  const std::string good = free_movements(3, 1);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "line 1"},
      {"time,x\n1,2\n", "line 1"},
      {good + "1,2,3\n", "line 5"},
      {good + "nan,0,0,0,0,0,0,1,0,0,0,0,0,0\n", "line 5, column 1 (hand_qw)"},
      {good + "1,0,0,0,0,0,0,1,0,0,0,0,0,inf\n", "line 5, column 14 (eye_z)"},
      {good + "0,0,0,0,0,0,0,1,0,0,0,0,0,0\n", "line 5, column 1 (hand_qw)"},
  };
  for (const auto& [text, where] : cases) {
    const Finished finished = run({handeye(), "solve", file(text), "--json"});
    EXPECT_EQ(finished.exit_code, 2) << text;
    EXPECT_EQ(finished.out, "");
    EXPECT_EQ(lines_of(finished.err).size(), 1U) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("poses.csv: " + where));
  }
}

}  // namespace
}  // namespace handeye::test
