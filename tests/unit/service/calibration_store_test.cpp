// SPDX-License-Identifier: BSD-3-Clause
// The last accepted calibration comes back as it was, or not at all.
#include "daemon/service/calibration_store.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/service/atomic_file.hpp"
#include "daemon/session/result_from_json.hpp"
#include "daemon/session/result_json.hpp"
#include "protocol/exit_codes.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye::test {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kSolved_utime = 1'790'000'000'000'000;
constexpr std::int64_t kHour_us = 3'600'000'000;

CalibrationResult accepted_result() {
  CalibrationResult result;
  result.request_id = -4611686018427387905;  // any 64 bits
  result.body_id = 3;
  result.verdict = Verdict::kAccepted;
  result.wanted = {0.25, 1.25};
  result.vintage = Vintage{.solved_utime = kSolved_utime, .age_s = 0};
  result.has_estimate = true;
  result.method = "one_step";
  result.solution.hand_from_eye = make_pose(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized(),
                                            Eigen::Vector3d(1.0 / 3, -20.25, 300.0 / 7));
  result.solution.scale_units_per_mm = 0.1;
  for (int axis = 0; axis < 6; ++axis) result.covariance(axis, axis) = 1e-6 / (axis + 3);
  result.covariance(0, 4) = result.covariance(4, 0) = 1e-8 / 3;
  result.sigma_rotation_deg = 0.1 / 3;
  result.sigma_translation_mm = 0.7 / 3;
  result.time_offset_s = -0.012345678901234567;
  result.time_offset_sigma_s = 1e-4 / 3;
  result.camera = {640, 480, 500.0 / 3, 501, 320, 240, {-0.3, 0.1, 1e-3, 2e-3, 0.05}};
  result.residuals = {0.1, 0.2, 0.3, 0.4};
  result.reprojection_px = 0.5;
  result.hand_noise = SampleNoise{0.07, 0.16, "measured"};
  result.image_noise_px = 0.3;
  result.methods.push_back({"andreff", std::nullopt, {}, 0.5});
  result.methods.push_back(
      {"one_step", result.solution, {0.1, 2, 3, 4}, 80, MethodSigma{0.05, 0.3}});
  result.frames = {500, 490, 120, 3, 6, 4, 2, 9, 5};
  result.features = {250.5, 4321};
  result.timings_ms = {2500, 900, 80, 20000};
  return result;
}

/// Equal but for the last bit of rotations, which go through quaternions.
void expect_equal(CalibrationResult found, const CalibrationResult& kept) {
  const auto settle = [](HandEyeSolution& of_found, const HandEyeSolution& of_kept) {
    EXPECT_TRUE(of_found.hand_from_eye.isApprox(of_kept.hand_from_eye, 1e-15));
    of_found.hand_from_eye = of_kept.hand_from_eye;
  };
  settle(found.solution, kept.solution);
  ASSERT_EQ(found.methods.size(), kept.methods.size());
  for (std::size_t i = 0; i < kept.methods.size(); ++i) {
    ASSERT_EQ(found.methods[i].solution.has_value(), kept.methods[i].solution.has_value());
    if (kept.methods[i].solution) settle(*found.methods[i].solution, *kept.methods[i].solution);
  }
  found.vintage = kept.vintage;
  EXPECT_EQ(to_json(found), to_json(kept));
}

std::string damaged(const TemporaryFolder& folder) {
  return folder / "last_calibration.json.damaged";
}

class CalibrationStoreTest : public testing::Test {
 protected:
  void expect_kept_aside() const {
    EXPECT_FALSE(std::filesystem::exists(store_.file()));
    EXPECT_TRUE(std::filesystem::exists(damaged(folder_)));
  }

  TemporaryFolder folder_;
  CalibrationStore store_{folder_ / "last_calibration.json"};
};

TEST_F(CalibrationStoreTest, GivesBackWhatWasKept) {
  const CalibrationResult kept = accepted_result();
  ASSERT_TRUE(store_.save(kept));
  const auto found = store_.load(kSolved_utime + kHour_us);
  ASSERT_TRUE(found.has_value());
  ASSERT_TRUE(found->vintage.has_value());
  EXPECT_EQ(found->vintage->solved_utime, kSolved_utime);
  EXPECT_EQ(found->vintage->age_s, 3600.0);
  EXPECT_TRUE(found->vintage->restored);
  EXPECT_EQ(found->covariance, kept.covariance);
  EXPECT_EQ(found->camera.fx, kept.camera.fx);
  EXPECT_EQ(found->time_offset_s, kept.time_offset_s);
  expect_equal(*found, kept);
}

TEST_F(CalibrationStoreTest, WithoutAnythingKeptThereIsNothingAndNoComplaint) {
  testing::internal::CaptureStdout();
  EXPECT_FALSE(store_.load(kSolved_utime).has_value());
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_FALSE(std::filesystem::exists(damaged(folder_)));
}

TEST_F(CalibrationStoreTest, TheLastOneCounts) {
  CalibrationResult result = accepted_result();
  ASSERT_TRUE(store_.save(result));
  result.request_id = 77;
  ASSERT_TRUE(store_.save(result));
  EXPECT_EQ(store_.load(kSolved_utime)->request_id, 77);
  store_.remove();
  EXPECT_FALSE(store_.load(kSolved_utime).has_value());
}

TEST_F(CalibrationStoreTest, FromAClockThatWasPutBackTheAgeIsNotKnown) {
  ASSERT_TRUE(store_.save(accepted_result()));
  const auto found = store_.load(kSolved_utime - 1);
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->vintage->age_s.has_value());
}

TEST_F(CalibrationStoreTest, FiguresThatDoNotExistComeBackAsNone) {
  CalibrationResult kept = accepted_result();
  kept.residuals.translation_percent = std::numeric_limits<double>::quiet_NaN();
  kept.time_offset_s.reset();
  kept.hand_noise.reset();
  ASSERT_TRUE(store_.save(kept));
  const auto found = store_.load(kSolved_utime);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(std::isnan(found->residuals.translation_percent));
  EXPECT_FALSE(found->time_offset_s.has_value());
  EXPECT_FALSE(found->hand_noise.has_value());
}

TEST_F(CalibrationStoreTest, KeepsALensAndABoard) {
  CalibrationResult kept = accepted_result();
  kept.camera_source = "estimated";
  kept.lens = LensQuality{.sigma = {1, 2, 0.01, 0.02, 0.3}, .observable = true};
  kept.board = std::get<Board>(parse_board("chessboard:9x6:5"));
  ASSERT_TRUE(store_.save(kept));
  const auto found = store_.load(kSolved_utime);
  ASSERT_TRUE(found.has_value());
  expect_equal(*found, kept);
}

TEST_F(CalibrationStoreTest, AFileCutOffAnywhereIsNoCalibration) {
  ASSERT_TRUE(store_.save(accepted_result()));
  const std::string whole = read_bytes(store_.file());
  // The last byte is the newline.
  for (std::size_t size = 0; size + 1 < whole.size(); size += 1 + whole.size() / 40) {
    write_bytes(store_.file(), whole.substr(0, size));
    EXPECT_FALSE(store_.load(kSolved_utime).has_value()) << size;
    expect_kept_aside();
  }
}

TEST_F(CalibrationStoreTest, ADigitThatChangedIsNoticed) {
  ASSERT_TRUE(store_.save(accepted_result()));
  const std::string whole = read_bytes(store_.file());
  int changed = 0;
  for (std::size_t at = whole.find("\"result\""); at < whole.size(); at += 7) {
    if (whole[at] < '0' || whole[at] > '9') continue;
    std::string other = whole;
    other[at] = other[at] == '5' ? '6' : '5';
    write_bytes(store_.file(), other);
    // A digit beyond a double's precision may change nothing.
    if (Json::parse(other) == Json::parse(whole)) continue;
    EXPECT_FALSE(store_.load(kSolved_utime).has_value()) << at;
    ++changed;
  }
  EXPECT_GT(changed, 50);
}

TEST_F(CalibrationStoreTest, AnotherVersionIsKeptAsideAndNotGuessedAt) {
  ASSERT_TRUE(store_.save(accepted_result()));
  Json file = Json::parse(read_bytes(store_.file()));
  file["version"] = 2;
  write_bytes(store_.file(), file.dump());
  EXPECT_FALSE(store_.load(kSolved_utime).has_value());
  expect_kept_aside();
  EXPECT_EQ(Json::parse(read_bytes(damaged(folder_))), file);
}

TEST_F(CalibrationStoreTest, ARefusedOneIsNone) {
  CalibrationResult refused = accepted_result();
  refused.verdict = Verdict::kRefused;
  ASSERT_TRUE(store_.save(refused));
  EXPECT_FALSE(store_.load(kSolved_utime).has_value());
}

TEST_F(CalibrationStoreTest, WhatCannotBeReadIsNoCalibration) {
  std::filesystem::create_directory(store_.file());
  EXPECT_FALSE(store_.load(kSolved_utime).has_value());
}

TEST_F(CalibrationStoreTest, WhatCannotBeWrittenLeavesTheOldOne) {
  ASSERT_TRUE(store_.save(accepted_result()));
  std::filesystem::create_directory(folder_ / "last_calibration.json.tmp");
  CalibrationResult other = accepted_result();
  other.request_id = 5;
  EXPECT_FALSE(store_.save(other));
  EXPECT_EQ(store_.load(kSolved_utime)->request_id, accepted_result().request_id);
}

TEST(StoreFile, IsTheConfiguredOneElseInTheStateDirectory) {
  Config::Calibration config;
  EXPECT_EQ(store_file(config, nullptr), "");
  EXPECT_EQ(store_file(config, ""), "");
  EXPECT_EQ(store_file(config, "/var/lib/handeyed"), "/var/lib/handeyed/last_calibration.json");
  EXPECT_EQ(store_file(config, "/a:/b"), "/a/last_calibration.json");
  config.store = "/else/where.json";
  EXPECT_EQ(store_file(config, "/var/lib/handeyed"), "/else/where.json");
}

TEST(ResultFromJson, SaysWhatIsWrong) {
  const Json good = to_json(accepted_result());
  const auto problem_with = [&](const char* key, const Json& value) {
    Json bad = good;
    bad[key] = value;
    try {
      result_from_json(bad);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(problem_with("advice", "anything"), "none");
  EXPECT_THAT(problem_with("verdict", "maybe"), testing::HasSubstr("maybe"));
  EXPECT_THAT(problem_with("hand_from_eye", {{"q_wxyz", {1, 1, 0, 0}}, {"t_mm", {0, 0, 0}}}),
              testing::HasSubstr("quaternion"));
  EXPECT_NE(problem_with("covariance", nullptr), "none");
  EXPECT_NE(problem_with("covariance", Json::array()), "none");
  EXPECT_NE(problem_with("camera", Json::object()), "none");
}

}  // namespace
}  // namespace handeye::test
