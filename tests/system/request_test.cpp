// SPDX-License-Identifier: BSD-3-Clause
// How the daemon takes requests: one at a time, each once, whoever sends them and whatever becomes
// of the sender.
#include <csignal>

#include <gmock/gmock.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr seconds kSoon{15};

/// A room with devices and a daemon, and calibrations that never end early: they want too much.
class RequestSystem : public RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(room_.start_simulator({.seed = 5, .camera_rate_hz = 12}));
    ASSERT_TRUE(room_.start_daemon());
  }

  static request_t long_start(double max_duration_s) {
    request_t request = start_request(max_duration_s);
    request.wanted_sigma_rotation_deg = 1e-3;
    request.wanted_sigma_translation_mm = 1e-3;
    return request;
  }
  std::vector<std::string> long_calibrate(const std::string& max_duration_s) const {
    return room_.client_words(
        "calibrate", {"--json", "--sigma", "0.001,0.001", "--max-duration", max_duration_s});
  }

  bool reaches(std::int32_t state, seconds timeout = kSoon) {
    return listener().spin_until([&] { return listener().session_state() == state; }, timeout);
  }
  bool gets_result(std::int64_t request_id, seconds timeout = kSoon) {
    return listener().spin_until([&] { return listener().result_of(request_id) != nullptr; },
                                 timeout);
  }
  Listener& listener() { return room_.listener(); }

  Room room_;
};

TEST_F(RequestSystem, ASecondStartIsToldWhichOneRuns) {
  const request_t first = long_start(60);
  ASSERT_TRUE(listener().ask(first));
  EXPECT_EQ(listener().ack_code(first.request_id), status_t::ACK_TAKEN);
  const request_t second = long_start(60);
  ASSERT_TRUE(listener().ask(second));
  EXPECT_EQ(listener().ack_code(second.request_id), status_t::ACK_BUSY);
  EXPECT_THAT(listener().ack_text(second.request_id), HasSubstr(std::to_string(first.request_id)));

  const Finished client = run(room_.client_words("calibrate", {"--json"}));
  EXPECT_EQ(client.exit_code, 3) << client.err;
  EXPECT_EQ(parse_json(client.out).at("reason"), "busy");
  EXPECT_THAT(client.err, HasSubstr(std::to_string(first.request_id)));

  // The first goes on, with frames coming in.
  listener().spin_for(seconds(1));
  EXPECT_EQ(listener().session_state(), status_t::COLLECTING);
  EXPECT_EQ(listener().running_request(), first.request_id);
  const int frames = listener().statuses().back().frames_collected;
  EXPECT_TRUE(listener().spin_until(
      [&] { return listener().statuses().back().frames_collected > frames + 5; }, kSoon));
}

TEST_F(RequestSystem, TheSameRequestFiveTimesIsOneCalibration) {
  const request_t request = long_start(4);
  for (int i = 0; i < 5; ++i) {
    listener().send(request);
    listener().spin_for(milliseconds(100));
  }
  ASSERT_TRUE(gets_result(request.request_id, seconds(60)));
  for (int i = 0; i < 5; ++i) listener().send(request);
  listener().spin_for(seconds(2));
  EXPECT_EQ(listener().results().size(), 1U);

  int times_collecting = 0;
  std::int32_t state = status_t::IDLE;
  for (const status_t& status : listener().statuses()) {
    if (status.session_state == status_t::COLLECTING && state != status_t::COLLECTING) {
      ++times_collecting;
    }
    state = status.session_state;
    EXPECT_LE(status.num_acks, 1);
  }
  EXPECT_EQ(times_collecting, 1);
  EXPECT_EQ(state, status_t::REFUSED) << "a sigma nobody reaches";
  EXPECT_EQ(listener().ack_code(request.request_id), status_t::ACK_TAKEN);
}

TEST_F(RequestSystem, AKilledClientLeavesTheDaemonUsable) {
  {
    Process client(long_calibrate("6"));
    ASSERT_TRUE(reaches(status_t::COLLECTING)) << client.err();
    client.send_signal(SIGKILL);
  }
  const std::int64_t orphan = listener().running_request();
  // Nobody waits for it, and it ends by itself.
  ASSERT_TRUE(reaches(status_t::REFUSED, seconds(60)));
  EXPECT_EQ(listener().running_request(), orphan);

  const request_t next = long_start(60);
  ASSERT_TRUE(listener().ask(next));
  EXPECT_EQ(listener().ack_code(next.request_id), status_t::ACK_TAKEN);
  EXPECT_TRUE(reaches(status_t::COLLECTING));
}

TEST_F(RequestSystem, AnotherClientCanCancelWhatAKilledOneStarted) {
  {
    Process client(long_calibrate("60"));
    ASSERT_TRUE(reaches(status_t::COLLECTING)) << client.err();
    client.send_signal(SIGKILL);
  }
  const Finished cancel = run(room_.client_words("cancel"));
  EXPECT_EQ(cancel.exit_code, 0) << cancel.err;
  EXPECT_TRUE(reaches(status_t::CANCELLED));
}

TEST_F(RequestSystem, CancelEndsItWithAResult) {
  const request_t start = long_start(60);
  ASSERT_TRUE(listener().ask(start));
  ASSERT_TRUE(reaches(status_t::COLLECTING));
  const request_t cancel = cancel_request(start.request_id);
  ASSERT_TRUE(listener().ask(cancel));
  EXPECT_EQ(listener().ack_code(cancel.request_id), status_t::ACK_TAKEN);
  ASSERT_TRUE(gets_result(start.request_id));
  const result_t& result = *listener().result_of(start.request_id);
  EXPECT_EQ(result.verdict, result_t::CANCELLED);
  EXPECT_EQ(result.reason, "cancelled");
  EXPECT_TRUE(reaches(status_t::CANCELLED));
  EXPECT_FALSE(listener().statuses().back().calibrated);

  const request_t again = cancel_request();
  ASSERT_TRUE(listener().ask(again));
  EXPECT_EQ(listener().ack_code(again.request_id), status_t::ACK_NOTHING_TO_DO);
}

TEST_F(RequestSystem, CtrlCCancels) {
  Process client(long_calibrate("60"));
  ASSERT_TRUE(reaches(status_t::COLLECTING)) << client.err();
  client.send_signal(SIGINT);
  const auto finished = client.wait(kSoon);
  ASSERT_TRUE(finished.has_value());
  EXPECT_EQ(finished->exit_code, 3) << finished->err;
  EXPECT_EQ(parse_json(finished->out).at("verdict"), "cancelled");
  EXPECT_TRUE(reaches(status_t::CANCELLED));
}

TEST_F(RequestSystem, FinishSolvesFromWhatIsThereAndDescribeTellsItAgain) {
  const request_t start = long_start(60);
  ASSERT_TRUE(listener().ask(start));
  ASSERT_TRUE(listener().spin_until(
      [&] { return listener().statuses().back().frames_collected > 30; }, seconds(60)));
  request_t finish = cancel_request(start.request_id);
  finish.action = request_t::FINISH;
  ASSERT_TRUE(listener().ask(finish));
  EXPECT_EQ(listener().ack_code(finish.request_id), status_t::ACK_TAKEN);
  ASSERT_TRUE(gets_result(start.request_id, seconds(60)));
  const result_t result = *listener().result_of(start.request_id);
  EXPECT_EQ(result.verdict, result_t::REFUSED) << "a sigma nobody reaches";
  EXPECT_GT(result.frames_received, 30);
  EXPECT_NE(result.reason, "");
  EXPECT_NE(result.advice, "");

  request_t describe = cancel_request();
  describe.action = request_t::DESCRIBE;
  ASSERT_TRUE(listener().ask(describe));
  ASSERT_TRUE(listener().spin_until([&] { return listener().results().size() >= 2; }, kSoon));
  const result_t& again = listener().results().back();
  EXPECT_EQ(again.request_id, start.request_id);
  EXPECT_THAT(again.t_mm, testing::ElementsAreArray(result.t_mm));
}

TEST_F(RequestSystem, WhatIsNoRequestIsRefusedInWords) {
  request_t nonsense = start_request(1);
  nonsense.action = 99;
  ASSERT_TRUE(listener().ask(nonsense));
  EXPECT_EQ(listener().ack_code(nonsense.request_id), status_t::ACK_BAD_REQUEST);
  EXPECT_THAT(listener().ack_text(nonsense.request_id), HasSubstr("99"));
  EXPECT_EQ(listener().session_state(), status_t::IDLE);
}

}  // namespace
}  // namespace handeye::test
