// SPDX-License-Identifier: BSD-3-Clause
// What people read: results, status, progress.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/cli/result_parts.hpp"
#include "client/cli/result_text.hpp"
#include "client/cli/status_text.hpp"
#include "client/cli/stream_counter.hpp"
#include "client/cli/terminal.hpp"
#include "tests/unit/client/scripted_daemon.hpp"

namespace handeye::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const Palette kPlain(false);
const Palette kColored(true);

CalibrationResult accepted_result() {
  CalibrationResult result;
  result.body_id = 2;
  result.verdict = Verdict::kAccepted;
  result.has_estimate = true;
  result.solution.hand_from_eye =
      make_pose(Eigen::Quaterniond(-0.5, -0.5, -0.5, -0.5), {1.25, -2.5, 301.125});
  result.sigma_rotation_deg = 0.081;
  result.sigma_translation_mm = 0.442;
  result.time_offset_s = -0.0123;
  result.time_offset_sigma_s = 0.0004;
  result.camera = {640, 480, 600, 601, 320, 240, {}};
  MethodResult solved{"park", HandEyeSolution{}, {0.12, 1.5, 2.5, 2.25}, 3.75};
  MethodResult unsolved{"horaud", std::nullopt, {}, 0.5};
  result.methods = {solved, unsolved};
  result.frames = {500, 480, 41, 7};
  return result;
}

TEST(ResultText, ShowsAnAcceptedResult) {
  const std::string text = result_text(accepted_result(), kPlain);
  EXPECT_THAT(text, ::testing::StartsWith("ACCEPTED  body 2\n"));
  EXPECT_THAT(text, HasSubstr("w 0.500000  x 0.500000  y 0.500000  z 0.500000"));
  EXPECT_THAT(text, HasSubstr("x 1.250  y -2.500  z 301.125 mm"));
  EXPECT_THAT(text, HasSubstr("0.081 deg (wanted 0.3)"));
  EXPECT_THAT(text, HasSubstr("0.442 mm (wanted 1.5)"));
  EXPECT_THAT(text, HasSubstr("-12.30 ms +- 0.40 ms"));
  EXPECT_THAT(text, HasSubstr("500 received, 480 used, 41 keyframes, 7 dropped"));
  EXPECT_THAT(text, Not(HasSubstr("must not be used")));
  EXPECT_THAT(text, Not(HasSubstr("\033")));
}

TEST(ResultText, ListsTheMethodsAndThoseWithoutASolution) {
  const std::string text = result_text(accepted_result(), kPlain);
  const std::string row = text.substr(text.find("park"), text.find('\n', text.find("park")));
  EXPECT_THAT(row, ::testing::ContainsRegex("park +2\\.500 +0\\.1200 +1\\.500 +3\\.75"));
  EXPECT_THAT(text, ::testing::ContainsRegex("horaud +no solution"));
}

TEST(ResultText, ARefusedEstimateIsMarkedAsSuch) {
  CalibrationResult result = accepted_result();
  result.verdict = Verdict::kRefused;
  result.reason = Reason::kSingleAxis;
  result.advice = "tilt about another axis as well";
  const std::string text = result_text(result, kPlain);
  EXPECT_THAT(text, ::testing::StartsWith("REFUSED: single_axis"));
  EXPECT_THAT(text, HasSubstr("tilt about another axis as well"));
  EXPECT_LT(text.find("must not be used"), text.find("hand_from_eye"));
}

TEST(ResultText, ARefusalWithoutAnEstimateShowsNone) {
  CalibrationResult result;
  result.reason = Reason::kTrackerLost;
  const std::string text = result_text(result, kPlain);
  EXPECT_THAT(text, HasSubstr("tracker_lost"));
  EXPECT_THAT(text, Not(HasSubstr("hand_from_eye")));
}

TEST(ResultText, ColorsTheVerdict) {
  EXPECT_THAT(result_text(accepted_result(), kColored), HasSubstr("\033[32;1mACCEPTED\033[0m"));
  EXPECT_THAT(result_text(CalibrationResult(), kColored), HasSubstr("\033[31;1mREFUSED\033[0m"));
}

TEST(EulerAngles, ComposeToTheRotationAgain) {
  for (const double roll : {-170.0, -30.0, 0.0, 90.0}) {
    for (const double pitch : {-90.0, -89.0, 0.0, 45.0, 90.0}) {
      for (const double yaw : {-120.0, 0.0, 10.0, 180.0}) {
        const auto rotation = [](double x_deg, double y_deg, double z_deg) {
          using Eigen::AngleAxisd;
          using Eigen::Vector3d;
          return (AngleAxisd(rad_from_deg(z_deg), Vector3d::UnitZ()) *
                  AngleAxisd(rad_from_deg(y_deg), Vector3d::UnitY()) *
                  AngleAxisd(rad_from_deg(x_deg), Vector3d::UnitX()))
              .toRotationMatrix();
        };
        const Eigen::Matrix3d wanted = rotation(roll, pitch, yaw);
        const EulerAngles angles = euler_angles(wanted);
        EXPECT_NEAR((rotation(angles.roll_deg, angles.pitch_deg, angles.yaw_deg) - wanted).norm(),
                    0, 1e-7)
            << roll << ' ' << pitch << ' ' << yaw;
      }
    }
  }
}

TEST(StatusText, ShowsBothDevices) {
  status_t status = test::idle_status();
  status.tracker.state = device_status_t::STREAMING;
  status.tracker.rate_hz = 60.02;
  status.tracker.age_s = 0.011;
  status.tracker.text = "DTrack on port 5000";
  status.camera.text = "/dev/endoscope0 not there";
  status.tracked_bodies = "0 2";
  const std::string text = status_text(status, kPlain);
  EXPECT_THAT(text, ::testing::ContainsRegex("tracker +streaming +60\\.0 +0\\.01 s"));
  EXPECT_THAT(text, ::testing::ContainsRegex("camera +absent .*never.*/dev/endoscope0 not there"));
  EXPECT_THAT(text, ::testing::ContainsRegex("bodies in view +0 2\n"));
  EXPECT_THAT(text, ::testing::ContainsRegex("session +idle\n"));
}

TEST(StatusText, NeverObeysControlCharactersFromTheNetwork) {
  status_t status = test::idle_status();
  status.camera.text = "\033[2Jgone\n";
  status.session_state = status_t::COLLECTING;
  status.guidance = "slide\r\033[31m";
  EXPECT_THAT(status_text(status, kPlain), Not(HasSubstr("\033")));
  EXPECT_THAT(progress_text(status), Not(HasSubstr("\r")));
}

TEST(StatusJson, CarriesNullForWhatIsNotKnownAndSurvivesBadText) {
  status_t status = test::idle_status();
  status.guidance = "\xff\xfe";
  const auto json = nlohmann::json::parse(dump_json(status_json(status)));
  EXPECT_TRUE(json.at("session").at("sigma_rotation_deg").is_null());
  EXPECT_TRUE(json.at("tracker").at("age_s").is_null());
  EXPECT_EQ(json.at("tracker").at("state"), "absent");
  EXPECT_EQ(json.at("calibrated"), false);
}

status_t collecting_status() {
  status_t status = test::idle_status();
  status.session_state = status_t::COLLECTING;
  status.has_estimate = true;
  status.q_wxyz[0] = 1;
  status.t_mm[2] = 301.26;
  status.sigma_rotation_deg = 0.41;
  status.sigma_translation_mm = 2.25;
  status.time_offset_s = -0.0123;
  status.time_offset_sigma_s = 0.0004;
  status.time_offset_confidence = 0.85;
  status.turned_deg[0] = 7.04;
  status.guidance_code = status_t::GUIDE_SLIDE_IN_AND_OUT;
  return status;
}

TEST(StatusText, ShowsTheAnswerAsItStands) {
  const std::string text = status_text(collecting_status(), kPlain);
  EXPECT_THAT(text, HasSubstr("estimate x 0.0  y 0.0  z 301.3 mm +- 2.25 mm, 0.41 deg"));
  EXPECT_THAT(text, HasSubstr("time offset -12.3 +- 0.4 ms, confidence 85 %"));
  EXPECT_THAT(text, HasSubstr("turned 7.0 deg up and down, 0.0 left and right, 0.0 roll"));
  status_t early = collecting_status();
  early.has_estimate = false;
  early.time_offset_sigma_s = -1;
  EXPECT_THAT(status_text(early, kPlain), HasSubstr("no estimate yet"));
  EXPECT_THAT(status_text(early, kPlain), HasSubstr("time offset not known yet"));
  EXPECT_THAT(status_text(early, kPlain), HasSubstr("turned: not known yet"));
}

TEST(StatusText, ShowsTheDevicesClocks) {
  status_t status = test::idle_status();
  EXPECT_THAT(status_text(status, kPlain), Not(HasSubstr("tracker clock")));
  status.tracker.clock.state = clock_status_t::STEADY;
  status.tracker.clock.drift_ppm = 12.34;
  status.tracker.clock.jitter_ms = 0.8;
  status.tracker.clock.span_s = 34;
  EXPECT_THAT(
      status_text(status, kPlain),
      HasSubstr("tracker clock   steady   drift +12.3 ppm, jitter 0.8 ms, holds for 34 s\n"));
  status.tracker.clock.jumps = 2;
  EXPECT_THAT(status_text(status, kPlain), HasSubstr(", jumped 2 times"));
  EXPECT_THAT(status_text(status, kPlain), Not(HasSubstr("midnight")));
  EXPECT_THAT(status_text(status, kPlain), Not(HasSubstr("out of order")));
  status.tracker.clock.midnights = 1;
  status.tracker.reordered = 12;
  EXPECT_THAT(status_text(status, kPlain), HasSubstr(", past midnight\n"));
  EXPECT_THAT(status_text(status, kPlain), HasSubstr(", 12 came out of order\n"));
  status.camera.clock.text = "nothing has come yet";
  EXPECT_THAT(status_text(status, kPlain), HasSubstr("camera clock    nothing has come yet\n"));
}

TEST(StatusText, TellsWhetherTheCalibrationHolds) {
  status_t status = test::idle_status();
  EXPECT_THAT(status_text(status, kPlain), Not(HasSubstr("calibration ")));
  status.calibrated = true;
  status.watch_state = status_t::WATCH_HOLDS;
  status.watch_age_s = 3;
  EXPECT_THAT(status_text(status, kPlain), HasSubstr("calibration     holds, checked 3 s ago\n"));
  status.watch_state = status_t::WATCH_BROKEN;
  status.watch_deviation_deg = 0.1;
  status.watch_text = "the camera head has moved by 4.2 mm: calibrate again";
  EXPECT_THAT(status_text(status, kPlain),
              HasSubstr("NO LONGER HOLDS, checked 3 s ago  the camera head has moved by 4.2 mm: "
                        "calibrate again\n"));
  EXPECT_THAT(status_text(status, kPlain), Not(HasSubstr("turned by"))) << "it was a shift";
  EXPECT_THAT(status_text(status, kColored), HasSubstr("\033[31;1mNO LONGER HOLDS"));
  status.watch_state = status_t::WATCH_DOUBTFUL;
  status.watch_text = "the camera head seems to have moved by 2.0 mm";
  EXPECT_THAT(
      status_text(status, kPlain),
      HasSubstr("doubtful, checked 3 s ago  the camera head seems to have moved by 2.0 mm\n"));
  status.watch_text.clear();
  status.watch_state = status_t::WATCH_UNCHECKED;
  status.watch_age_s = -1;
  EXPECT_THAT(status_text(status, kPlain), HasSubstr("unchecked, never checked yet"));
}

TEST(StatusJson, CarriesTheAnswerAsItStandsClocksAndWatch) {
  status_t status = collecting_status();
  status.watch_state = status_t::WATCH_DOUBTFUL;
  status.camera.clock.state = clock_status_t::SETTLING;
  const auto json = nlohmann::json::parse(dump_json(status_json(status)));
  const auto& session = json.at("session");
  EXPECT_EQ(session.at("hand_from_eye").at("t_mm").at(2), 301.26);
  EXPECT_EQ(session.at("time_offset").at("confidence"), 0.85);
  EXPECT_EQ(session.at("turned_deg").at(0), 7.04);
  EXPECT_EQ(session.at("guidance_code"), "slide_in_and_out");
  EXPECT_EQ(json.at("watch").at("state"), "doubtful");
  EXPECT_EQ(json.at("camera").at("clock").at("state"), "settling");
  const auto idle = nlohmann::json::parse(dump_json(status_json(test::idle_status())));
  EXPECT_TRUE(idle.at("session").at("hand_from_eye").is_null());
  EXPECT_TRUE(idle.at("session").at("time_offset").is_null());
}

TEST(StatusWords, NameWhatThisVersionDoesNotKnow) {
  EXPECT_EQ(guide_word(17), "guide 17");
  EXPECT_EQ(watch_state_word(-1), "state -1");
  EXPECT_EQ(session_state_word(status_t::SOLVING), "solving");
  EXPECT_EQ(guide_word(status_t::GUIDE_ROLL), "roll");
}

TEST(ProgressText, TellsSigmaAgainstTheWantedAndWhatToDo) {
  status_t status = test::idle_status();
  status.session_state = status_t::COLLECTING;
  status.progress = 0.5;
  status.elapsed_s = 6.2;
  status.sigma_rotation_deg = 0.41;
  status.guidance = "tilt up and down";
  const std::string text = progress_text(status);
  EXPECT_THAT(text, HasSubstr("[######......]  50 %  tilt up and down  ("));
  EXPECT_THAT(text, HasSubstr("0.41/0.3 deg"));
  EXPECT_THAT(text, HasSubstr("?/1.5 mm, 6 s)"));
}

TEST(ProgressBar, StaysWithinItsBrackets) {
  EXPECT_EQ(progress_bar(0, 4), "[....]");
  EXPECT_EQ(progress_bar(1, 4), "[####]");
  EXPECT_EQ(progress_bar(7, 4), "[####]");
  EXPECT_EQ(progress_bar(-1, 4), "[....]");
  EXPECT_EQ(progress_bar(std::numeric_limits<double>::quiet_NaN(), 4), "[....]");
}

TEST(StreamCounter, CountsGapsButNoRestarts) {
  StreamCounter counter;
  counter.take(1, 5);  // the first message heard is no gap
  counter.take(1, 6);
  counter.take(1, 9);
  EXPECT_EQ(counter.lost(), 2);
  counter.take(2, 0);
  counter.take(2, 1);
  EXPECT_EQ(counter.lost(), 2);
  EXPECT_EQ(counter.received(), 5);
}

}  // namespace
}  // namespace handeye::cli
