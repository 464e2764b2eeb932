// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/status_message.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handeye {
namespace {

using testing::HasSubstr;

request_t good_request(std::int32_t action = request_t::START) {
  request_t message{};
  message.protocol_version = request_t::VERSION;
  message.request_id = 42;
  message.action = action;
  message.target_request_id = 7;
  message.body_id = 3;
  message.wanted_sigma_rotation_deg = 0.2;
  message.wanted_sigma_translation_mm = 0.8;
  message.max_duration_s = 20;
  return message;
}

std::string problem_with(const request_t& message) {
  std::string problem;
  EXPECT_FALSE(read_request(message, problem).has_value());
  return problem;
}

TEST(ReadRequest, TakesEveryField) {
  std::string problem;
  const auto request = read_request(good_request(), problem);
  ASSERT_TRUE(request.has_value()) << problem;
  EXPECT_EQ(request->request_id, 42);
  EXPECT_EQ(request->action, Action::kStart);
  EXPECT_EQ(request->target_request_id, 7);
  EXPECT_EQ(request->body_id, 3);
  EXPECT_EQ(request->wanted.rotation_deg, 0.2);
  EXPECT_EQ(request->wanted.translation_mm, 0.8);
  EXPECT_EQ(request->max_duration_s, 20);
}

TEST(ReadRequest, KnowsEveryAction) {
  const std::pair<std::int32_t, Action> kActions[] = {{request_t::START, Action::kStart},
                                                      {request_t::FINISH, Action::kFinish},
                                                      {request_t::CANCEL, Action::kCancel},
                                                      {request_t::DESCRIBE, Action::kDescribe},
                                                      {request_t::RECORD, Action::kRecord}};
  for (const auto& [code, action] : kActions) {
    std::string problem;
    const auto request = read_request(good_request(code), problem);
    ASSERT_TRUE(request.has_value()) << code << problem;
    EXPECT_EQ(request->action, action);
  }
}

TEST(ReadRequest, RejectsNonsenseInWords) {
  for (const std::int32_t action : {-1, 0, 6, 99}) {
    EXPECT_THAT(problem_with(good_request(action)), HasSubstr(std::to_string(action)));
  }
  request_t other_version = good_request();
  other_version.protocol_version = request_t::VERSION + 1;
  EXPECT_THAT(problem_with(other_version),
              HasSubstr("version " + std::to_string(request_t::VERSION)));
  request_t no_id = good_request();
  no_id.request_id = 0;
  EXPECT_THAT(problem_with(no_id), HasSubstr("request_id"));
}

TEST(ReadRequest, TakesABoard) {
  request_t message = good_request();
  std::string problem;
  EXPECT_FALSE(read_request(message, problem)->board);
  message.eye = request_t::EYE_PATTERN;
  message.board = "charuco:8x6:6:4.5:DICT_4X4_50";
  const auto request = read_request(message, problem);
  ASSERT_TRUE(request && request->board) << problem;
  EXPECT_EQ(to_string(*request->board), message.board);
}

TEST(ReadRequest, RejectsAnEyeWithoutItsBoard) {
  request_t message = good_request();
  message.board = "chessboard:9x6:4";
  EXPECT_THAT(problem_with(message), HasSubstr("board"));
  message.eye = request_t::EYE_PATTERN;
  message.board = "";
  EXPECT_THAT(problem_with(message), HasSubstr("chessboard:COLSxROWS:SQUARE_MM"));
  message.board = "chessboard:9y6:4";
  EXPECT_THAT(problem_with(message), HasSubstr("9x6"));
  message.board = "";
  message.eye = 2;
  EXPECT_THAT(problem_with(message), HasSubstr("eye 2"));
}

TEST(ReadRequest, RejectsABoardThatCannotBeFound) {
  request_t message = good_request();
  message.eye = request_t::EYE_PATTERN;
  message.board = "chessboard:2x6:5";
  EXPECT_THAT(problem_with(message), HasSubstr("3 to 100 inner corners"));
  message.board = "charuco:20x20:5:3:DICT_4X4_50";
  EXPECT_THAT(problem_with(message), HasSubstr("has 50"));
}

TEST(ReadRequest, ReadsEyeAndBoardOfAStartOnly) {
  for (const std::int32_t action : std::vector<std::int32_t>{
           request_t::FINISH, request_t::CANCEL, request_t::DESCRIBE, request_t::RECORD}) {
    request_t message = good_request(action);
    message.eye = 77;
    message.board = "tablecloth";
    std::string problem;
    const auto request = read_request(message, problem);
    ASSERT_TRUE(request) << action << problem;
    EXPECT_FALSE(request->board);
  }
}

TEST(WriteSession, TellsStateRequestAndAcknowledgements) {
  Session session(SessionDefaults{});
  status_t status{};
  write_session(session, status);
  EXPECT_EQ(status.session_state, status_t::IDLE);
  EXPECT_EQ(status.request_id, 0);
  EXPECT_EQ(status.num_acks, 0);

  session.on_request({.request_id = 1, .action = Action::kStart, .max_duration_s = 20});
  session.on_request({.request_id = 2, .action = Action::kStart});
  session.refuse({3, AckCode::kBadRequest, "unknown action 99"});
  session.on_request({.request_id = 4, .action = Action::kDescribe});
  status = {};
  write_session(session, status);
  EXPECT_EQ(status.session_state, status_t::COLLECTING);
  EXPECT_EQ(status.request_id, 1);
  EXPECT_EQ(status.max_duration_s, 20);
  EXPECT_THAT(status.ack_request_id, testing::ElementsAre(4, 3, 2, 1)) << "newest first";
  EXPECT_THAT(status.ack_code,
              testing::ElementsAre(status_t::ACK_NOTHING_TO_DO, status_t::ACK_BAD_REQUEST,
                                   status_t::ACK_BUSY, status_t::ACK_TAKEN));
  EXPECT_EQ(status.ack_text[3], "");
  EXPECT_THAT(status.ack_text[2], HasSubstr("1"));
  EXPECT_GT(status.getEncodedSize(), 0);
}

TEST(WriteSession, FollowsTheSession) {
  const std::pair<Verdict, std::int32_t> kEnds[] = {{Verdict::kAccepted, status_t::DONE},
                                                    {Verdict::kRefused, status_t::REFUSED},
                                                    {Verdict::kCancelled, status_t::CANCELLED}};
  Session session(SessionDefaults{});
  std::int64_t id = 0;
  for (const auto& [verdict, state] : kEnds) {
    session.on_request({.request_id = ++id, .action = Action::kStart});
    session.on_solving();
    status_t status{};
    write_session(session, status);
    EXPECT_EQ(status.session_state, status_t::SOLVING);
    CalibrationResult result;
    result.verdict = verdict;
    session.on_result(result);
    status = {};
    write_session(session, status);
    EXPECT_EQ(status.session_state, state);
  }
}

TEST(WriteSession, KeepsTheSixteenNewestAcknowledgements) {
  Session session(SessionDefaults{});
  for (std::int64_t id = 1; id <= 40; ++id) {
    session.on_request({.request_id = id, .action = Action::kDescribe});
  }
  status_t status{};
  write_session(session, status);
  EXPECT_EQ(status.num_acks, 16);
  EXPECT_EQ(status.ack_request_id.size(), 16U);
  EXPECT_EQ(status.ack_code.size(), 16U);
  EXPECT_EQ(status.ack_text.size(), 16U);
  EXPECT_EQ(status.ack_request_id.front(), 40);
  EXPECT_EQ(status.ack_request_id.back(), 25);
}

status_t progress_status(const CalibrationProgress& progress, double elapsed_s) {
  status_t status{};
  write_progress(progress,
                 {.wanted = {.rotation_deg = 0.3, .translation_mm = 1.5},
                  .min_duration_s = 8,
                  .max_duration_s = 30,
                  .elapsed_s = elapsed_s},
                 status);
  return status;
}

CalibrationProgress with_sigma(double rotation_deg, double translation_mm) {
  CalibrationProgress progress;
  progress.provisional.sigma = MethodSigma{rotation_deg, translation_mm};
  return progress;
}

TEST(WriteProgress, WithoutAnEstimateIsThatOfTheClock) {
  CalibrationProgress progress;
  progress.guidance = {GuideCode::kTiltUpAndDown, "tilt up and down"};
  const status_t status = progress_status(progress, 6);
  EXPECT_DOUBLE_EQ(status.progress, 0.2);
  EXPECT_EQ(status.elapsed_s, 6);
  EXPECT_EQ(status.sigma_rotation_deg, -1);
  EXPECT_EQ(status.sigma_translation_mm, -1);
  EXPECT_EQ(status.time_offset_sigma_s, -1);
  EXPECT_FALSE(status.has_estimate);
  EXPECT_EQ(status.q_wxyz[0], 0) << "no estimate must not look like one";
  EXPECT_EQ(status.guidance_code, status_t::GUIDE_TILT_UP_AND_DOWN);
  EXPECT_EQ(status.guidance, "tilt up and down");
}

TEST(WriteProgress, IsThatOfTheWorseSigma) {
  // Rotation is there; translation is at twice what is wanted: a quarter of the time it takes.
  CalibrationProgress progress = with_sigma(0.2, 3.0);
  progress.situation.keyframes = 12;
  progress.situation.rotation_coverage_deg = 33;
  progress.situation.translation_coverage_mm = 120;
  const status_t status = progress_status(progress, 5);
  EXPECT_DOUBLE_EQ(status.progress, 0.25);
  EXPECT_EQ(status.sigma_rotation_deg, 0.2);
  EXPECT_EQ(status.sigma_translation_mm, 3.0);
  EXPECT_EQ(status.keyframes, 12);
  EXPECT_EQ(status.rotation_coverage_deg, 33);
  EXPECT_EQ(status.translation_coverage_mm, 120);
}

TEST(WriteProgress, CountsTheShortestDurationToo) {
  EXPECT_DOUBLE_EQ(progress_status(with_sigma(0.01, 0.01), 2).progress, 0.25);
  EXPECT_LT(progress_status(with_sigma(0.01, 0.01), 12).progress, 1) << "not confirmed yet";
}

TEST(WriteProgress, StaysBetweenZeroAndOne) {
  EXPECT_EQ(progress_status({}, 0).progress, 0);
  EXPECT_EQ(progress_status({}, 31).progress, 1);
  EXPECT_EQ(progress_status(with_sigma(0.01, 0.01), 31).progress, 1);
}

TEST(WriteProgress, CarriesTheAnswerAsItStands) {
  CalibrationProgress progress = with_sigma(0.2, 1.0);
  Provisional& answer = progress.provisional;
  answer.solution = HandEyeSolution{};
  answer.solution->hand_from_eye = make_pose({0.5, 0.5, 0.5, 0.5}, Eigen::Vector3d(1.0, 2.0, 3.0));
  answer.time_offset_s = 0.03;
  answer.time_offset_sigma_s = 0.001;
  answer.time_offset_confidence = 0.8;
  answer.turned_deg = {4, 5, 6};
  const status_t status = progress_status(progress, 5);
  EXPECT_TRUE(status.has_estimate);
  for (const double q : status.q_wxyz) EXPECT_NEAR(q, 0.5, 1e-12);
  EXPECT_EQ(status.t_mm[2], 3);
  EXPECT_EQ(status.time_offset_s, 0.03);
  EXPECT_EQ(status.time_offset_sigma_s, 0.001);
  EXPECT_EQ(status.time_offset_confidence, 0.8);
  EXPECT_EQ(status.turned_deg[0], 4);
  EXPECT_EQ(status.turned_deg[2], 6);
}

}  // namespace
}  // namespace handeye
