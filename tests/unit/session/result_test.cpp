// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/result.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/session/result_json.hpp"
#include "daemon/session/result_message.hpp"

namespace handeye {
namespace {

CalibrationResult full_result() {
  CalibrationResult result;
  result.request_id = 123456789012345;
  result.body_id = 2;
  result.verdict = Verdict::kRefused;
  result.reason = Reason::kFixedPoint;
  result.advice = std::string(reason_advice(Reason::kFixedPoint));
  result.missing = "slide_in_and_out";
  result.has_estimate = true;
  result.method = "one_step";
  result.solution.hand_from_eye =
      make_pose(Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), Eigen::Vector3d(1.5, -2.5, 300));
  result.solution.scale_units_per_mm = 0.0125;
  for (int i = 0; i < 36; ++i) result.covariance(i / 6, i % 6) = 0.01 * i;
  result.sigma_rotation_deg = 0.07;
  result.sigma_translation_mm = 0.4;
  result.time_offset_s = 0.0215;
  result.time_offset_sigma_s = 0.0003;
  result.camera = {640, 480, 600, 601, 320, 240, {0.1, -0.2, 0.001, 0.002, 0.3}};
  result.residuals = {0.1, 2, 3, 4};
  result.reprojection_px = 0.31;
  result.hand_noise = SampleNoise{0.06, 0.15, "measured"};
  result.image_noise_px = 0.2;
  result.methods.push_back({"andreff", result.solution, {0.2, 3, 4, 5}, 1.5});
  result.methods.push_back(
      {"one_step", result.solution, {0.1, 2, 3, 4}, 80, MethodSigma{0.05, 0.3}});
  result.methods.push_back({"failed", std::nullopt, {}, 0.5});
  result.frames = {500, 490, 120, 3, 6, 4, 2, 9, 5};
  result.features = {250.5, 4321};
  result.timings_ms = {2500, 900, 80, 20000};
  return result;
}

TEST(Result, SurvivesTheJourneyOverLcm) {
  const CalibrationResult result = full_result();
  result_t message = to_message(result);
  std::vector<std::uint8_t> wire(static_cast<std::size_t>(message.getEncodedSize()));
  ASSERT_GT(message.encode(wire.data(), 0, static_cast<int>(wire.size())), 0);
  result_t received{};
  ASSERT_GT(received.decode(wire.data(), 0, static_cast<int>(wire.size())), 0);
  EXPECT_EQ(to_json(from_message(received)), to_json(result));
}

TEST(Result, SaysWhatALensIsWorth) {
  EXPECT_FALSE(to_json(full_result())["camera"].contains("sigma")) << "it was given";
  CalibrationResult result = full_result();
  result.camera_source = "estimated";
  result.lens = LensQuality{{1.5, 2.5, 0.003, 0.004, 0.7}, true};
  const auto camera = to_json(from_message(to_message(result)))["camera"];
  EXPECT_EQ(camera["source"], "estimated");
  EXPECT_EQ(camera["observable"], true);
  EXPECT_EQ(camera["sigma"]["focal_px"], 1.5);
  EXPECT_EQ(camera["sigma"]["centre_px"], 2.5);
  EXPECT_EQ(camera["sigma"]["k1"], 0.003);
  EXPECT_EQ(camera["sigma"]["k2"], 0.004);
  EXPECT_EQ(camera["sigma"]["distortion_px"], 0.7);
}

TEST(Result, WithoutAnEstimateCarriesNoNumbersThatCouldBeMistakenForOne) {
  CalibrationResult result = full_result();
  result.has_estimate = false;
  result.time_offset_s.reset();
  result.time_offset_sigma_s.reset();
  const auto json = to_json(from_message(to_message(result)));
  EXPECT_TRUE(json["hand_from_eye"].is_null());
  EXPECT_TRUE(json["covariance"].is_null());
  EXPECT_TRUE(json["sigma_rotation_deg"].is_null());
  EXPECT_TRUE(json["time_offset_s"].is_null());
  EXPECT_TRUE(json["method"].is_null());
  EXPECT_TRUE(json["methods"][2]["hand_from_eye"].is_null());
}

TEST(Result, SaysByWhatTheAnswerWasWeighted) {
  const auto json = to_json(from_message(to_message(full_result())));
  EXPECT_EQ(json["method"], "one_step");
  EXPECT_EQ(json["missing"], "slide_in_and_out");
  EXPECT_EQ(json["hand_noise"]["rotation_deg"], 0.06);
  EXPECT_EQ(json["hand_noise"]["translation_mm"], 0.15);
  EXPECT_EQ(json["hand_noise"]["source"], "measured");
  EXPECT_EQ(json["image_noise_px"], 0.2);
  EXPECT_FALSE(json["methods"][0].contains("sigma")) << "it is not known";
  EXPECT_EQ(json["methods"][1]["sigma"]["rotation_deg"], 0.05);
  EXPECT_EQ(json["methods"][1]["sigma"]["translation_mm"], 0.3);
}

TEST(Result, HasNullWhereNoNoiseAndNoMotionIsNamed) {
  const auto json = to_json(from_message(to_message(CalibrationResult{})));
  for (const char* field : {"method", "missing", "hand_noise", "image_noise_px"}) {
    ASSERT_TRUE(json.contains(field)) << field;
    EXPECT_TRUE(json[field].is_null()) << field;
  }
}

TEST(Result, JsonHasTheDocumentedShape) {
  const auto json = to_json(full_result());
  EXPECT_EQ(json["verdict"], "refused");
  EXPECT_EQ(json["reason"], "fixed_point");
  EXPECT_EQ(json["hand_from_eye"]["q_wxyz"].size(), 4U);
  EXPECT_EQ(json["hand_from_eye"]["t_mm"][2], 300.0);
  EXPECT_EQ(json["covariance"].size(), 6U);
  EXPECT_EQ(json["covariance"][1].size(), 6U);
  EXPECT_EQ(json["camera"]["source"], "given");
  EXPECT_EQ(json["residuals"]["reprojection_px"], 0.31);
  EXPECT_EQ(json["frames"]["keyframes"], 120);
  EXPECT_EQ(json["timings_ms"]["total"], 20000.0);
}

TEST(Result, JsonNeverHoldsNan) {
  CalibrationResult result = full_result();
  result.sigma_rotation_deg = std::numeric_limits<double>::quiet_NaN();
  result.covariance(0, 0) = std::numeric_limits<double>::infinity();
  const auto json = to_json(result);
  EXPECT_TRUE(json["sigma_rotation_deg"].is_null());
  EXPECT_TRUE(json["covariance"][0][0].is_null());
}

TEST(Result, EveryRefusalHasAWordAndAdvice) {
  for (int code = 1; code <= static_cast<int>(Reason::kCancelled); ++code) {
    const auto reason = static_cast<Reason>(code);
    EXPECT_FALSE(reason_word(reason).empty()) << code;
    EXPECT_EQ(reason_from_word(reason_word(reason)), reason);
    EXPECT_EQ(reason_advice(reason).empty(), reason == Reason::kCancelled) << reason_word(reason);
  }
  EXPECT_EQ(reason_word(Reason::kNone), "");
  EXPECT_EQ(reason_from_word("a word of a later version"), Reason::kUncertain);
}

}  // namespace
}  // namespace handeye
