// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/session.hpp"

#include <gtest/gtest.h>

namespace handeye {
namespace {

using Command = Session::Command;

const SessionDefaults kDefaults{
    .body_id = 3, .wanted = {.rotation_deg = 0.3, .translation_mm = 1.5}, .max_duration_s = 30};

Request start_request(std::int64_t id) {
  return {.request_id = id, .action = Action::kStart};
}

CalibrationResult result_with(Verdict verdict) {
  CalibrationResult result;
  result.verdict = verdict;
  return result;
}

TEST(Session, StartsIdle) {
  const Session session(kDefaults);
  EXPECT_EQ(session.state(), SessionState::kIdle);
  EXPECT_EQ(session.current(), nullptr);
  EXPECT_EQ(session.last_result(), nullptr);
}

TEST(Session, FillsInTheConfiguredDefaults) {
  Session session(kDefaults);
  EXPECT_EQ(session.on_request(start_request(7)), Command::kStart);
  EXPECT_EQ(session.state(), SessionState::kCollecting);
  ASSERT_NE(session.current(), nullptr);
  EXPECT_EQ(session.current()->request_id, 7);
  EXPECT_EQ(session.current()->body_id, 3);
  EXPECT_DOUBLE_EQ(session.current()->wanted.rotation_deg, 0.3);
  EXPECT_DOUBLE_EQ(session.current()->max_duration_s, 30);
}

TEST(Session, KeepsWhatTheClientAsksFor) {
  Session session(kDefaults);
  Request request = start_request(7);
  request.body_id = 0;
  request.wanted = {0.1, 0.5};
  request.max_duration_s = 12;
  session.on_request(request);
  EXPECT_EQ(session.current()->body_id, 0);
  EXPECT_DOUBLE_EQ(session.current()->wanted.translation_mm, 0.5);
  EXPECT_DOUBLE_EQ(session.current()->max_duration_s, 12);
}

TEST(Session, ActsOnceOnARepeatedStart) {
  Session session(kDefaults);
  EXPECT_EQ(session.on_request(start_request(7)), Command::kStart);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(session.on_request(start_request(7)), Command::kNothing);
  session.on_result(result_with(Verdict::kAccepted));
  EXPECT_EQ(session.on_request(start_request(7)), Command::kNothing)
      << "also after the calibration has ended";
  EXPECT_EQ(session.acks().size(), 1U);
}

TEST(Session, RefusesASecondStartWhileOneRuns) {
  Session session(kDefaults);
  session.on_request(start_request(7));
  EXPECT_EQ(session.on_request(start_request(8)), Command::kNothing);
  ASSERT_EQ(session.acks().front().request_id, 8);
  EXPECT_EQ(session.acks().front().code, AckCode::kBusy);
  EXPECT_NE(session.acks().front().text.find("7"), std::string::npos) << "names the one that runs";
  EXPECT_EQ(session.current()->request_id, 7);
}

TEST(Session, RefusesNonsense) {
  Session session(kDefaults);
  std::int64_t id = 1;
  for (const int body_id : {-2, 1000}) {
    Request request = start_request(id++);
    request.body_id = body_id;
    EXPECT_EQ(session.on_request(request), Command::kNothing);
    EXPECT_EQ(session.acks().front().code, AckCode::kBadRequest);
  }
  for (const double duration_s : {601.0, std::nan("")}) {
    Request request = start_request(id++);
    request.max_duration_s = duration_s;
    EXPECT_EQ(session.on_request(request), Command::kNothing);
    EXPECT_EQ(session.acks().front().code, AckCode::kBadRequest);
  }
  Request request = start_request(id++);
  request.wanted.rotation_deg = std::nan("");
  EXPECT_EQ(session.on_request(request), Command::kNothing);
  EXPECT_EQ(session.state(), SessionState::kIdle);
}

TEST(Session, CancelsAndFinishesWhatRuns) {
  for (const auto& [action, command] : {std::pair{Action::kCancel, Command::kCancel},
                                        std::pair{Action::kFinish, Command::kFinish}}) {
    Session session(kDefaults);
    EXPECT_EQ(session.on_request({.request_id = 1, .action = action}), Command::kNothing);
    EXPECT_EQ(session.acks().front().code, AckCode::kNothingToDo);
    session.on_request(start_request(2));
    EXPECT_EQ(session.on_request({.request_id = 3, .action = action, .target_request_id = 99}),
              Command::kNothing)
        << "another calibration was meant";
    EXPECT_EQ(session.on_request({.request_id = 4, .action = action, .target_request_id = 2}),
              command);
    EXPECT_EQ(session.on_request({.request_id = 4, .action = action, .target_request_id = 2}),
              Command::kNothing);
  }
}

TEST(Session, DescribesTheLastResultAsOftenAsAsked) {
  Session session(kDefaults);
  EXPECT_EQ(session.on_request({.request_id = 1, .action = Action::kDescribe}), Command::kNothing);
  session.on_request(start_request(2));
  session.on_result(result_with(Verdict::kRefused));
  const Request describe{.request_id = 3, .action = Action::kDescribe};
  EXPECT_EQ(session.on_request(describe), Command::kDescribe);
  EXPECT_EQ(session.on_request(describe), Command::kDescribe) << "the first answer may be lost";
}

TEST(Session, EndsInTheStateOfItsVerdict) {
  for (const auto& [verdict, state] : {std::pair{Verdict::kAccepted, SessionState::kDone},
                                       std::pair{Verdict::kRefused, SessionState::kRefused},
                                       std::pair{Verdict::kCancelled, SessionState::kCancelled}}) {
    Session session(kDefaults);
    session.on_request(start_request(1));
    session.on_solving();
    EXPECT_EQ(session.state(), SessionState::kSolving);
    EXPECT_EQ(session.on_request(start_request(2)), Command::kNothing) << "solving is running too";
    session.on_result(result_with(verdict));
    EXPECT_EQ(session.state(), state);
    EXPECT_EQ(session.on_request(start_request(3)), Command::kStart) << "the next may come";
  }
}

TEST(Session, RemembersABoundedNumberOfRequests) {
  Session session(kDefaults);
  for (std::int64_t id = 1; id <= 1000; ++id) {
    session.on_request({.request_id = id, .action = Action::kDescribe});
  }
  EXPECT_LE(session.acks().size(), 256U);
  EXPECT_EQ(session.acks().front().request_id, 1000);
}

}  // namespace
}  // namespace handeye
