// SPDX-License-Identifier: BSD-3-Clause
#include "client/library/remote_calibration.hpp"

#include <gtest/gtest.h>

#include "tests/unit/client/scripted_daemon.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;
using Kind = CalibrationOutcome::Kind;
using test::ScriptedDaemon;

/// Begins the calibration that was asked for, as the daemon would.
void begin(ScriptedDaemon& daemon, const request_t& request) {
  daemon.acknowledge(request);
  daemon.status().request_id = request.request_id;
  daemon.status().session_state = status_t::COLLECTING;
  daemon.status().max_duration_s = 30;
}

class RemoteCalibrationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto problem = test::lcm_problem()) GTEST_SKIP() << *problem;
    client_options_.lcm_url = provider_;
    client_options_.request_period = milliseconds(40);
    limits_.describe_period = milliseconds(60);
    // Generous where time must not decide; the tests of a time-out shorten theirs.
    limits_.first_status = milliseconds(10000);
    limits_.acknowledgement = milliseconds(10000);
    limits_.silence = milliseconds(10000);
    limits_.total = milliseconds(20000);
  }

  CalibrationOutcome run() {
    Client client(client_options_);
    return calibrate(client, {}, limits_);
  }

  std::string provider_ = test::private_provider();
  ClientOptions client_options_;
  CalibrationLimits limits_;
};

TEST_F(RemoteCalibrationTest, EndsWithTheResult) {
  for (const auto& [verdict, kind] : {std::pair{+result_t::ACCEPTED, Kind::kAccepted},
                                      std::pair{+result_t::REFUSED, Kind::kRefused},
                                      std::pair{+result_t::CANCELLED, Kind::kCancelled}}) {
    ScriptedDaemon daemon(provider_,
                          [verdict = verdict](ScriptedDaemon& self, const request_t& request) {
                            begin(self, request);
                            self.send_result(test::result_message(request.request_id, verdict));
                          });
    const CalibrationOutcome outcome = run();
    EXPECT_EQ(outcome.kind, kind);
    ASSERT_TRUE(outcome.result.has_value());
    EXPECT_EQ(outcome.result->request_id, outcome.request_id);
  }
}

TEST_F(RemoteCalibrationTest, IgnoresTheResultOfAnother) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    begin(self, request);
    self.send_result(test::result_message(request.request_id ^ 1, result_t::ACCEPTED));
    self.send_result(test::result_message(request.request_id, result_t::REFUSED));
  });
  const CalibrationOutcome outcome = run();
  EXPECT_EQ(outcome.kind, Kind::kRefused);
}

TEST_F(RemoteCalibrationTest, AsksAgainForALostResultUntilItComes) {
  int described = 0;
  ScriptedDaemon daemon(provider_, [&](ScriptedDaemon& self, const request_t& request) {
    if (request.action == request_t::START) {
      begin(self, request);
      self.status().session_state = status_t::DONE;  // and the RESULT is lost
    } else if (self.times_heard(request.request_id) == 1) {
      self.acknowledge(request);
      // The answer to the first DESCRIBE is lost as well.
      if (++described < 2) return;
      self.send_result(test::result_message(self.status().request_id, result_t::ACCEPTED));
    }
  });
  const CalibrationOutcome outcome = run();
  EXPECT_EQ(outcome.kind, Kind::kAccepted);
  EXPECT_TRUE(outcome.result.has_value());
  EXPECT_EQ(daemon.distinct_ids(request_t::START).size(), 1u);
  EXPECT_GE(daemon.distinct_ids(request_t::DESCRIBE).size(), 2u);
}

TEST_F(RemoteCalibrationTest, AsksForTheResultWhenTheNextCalibrationHasBegun) {
  std::int64_t ours = 0;
  ScriptedDaemon daemon(provider_, [&](ScriptedDaemon& self, const request_t& request) {
    if (request.action == request_t::START) {
      if (self.times_heard(request.request_id) > 1) return;
      begin(self, request);
      ours = request.request_id;
    } else if (request.action == request_t::FINISH) {
      self.acknowledge(request);
      self.status().request_id = ours ^ 1;  // somebody else's, between two STATUS
    } else {
      self.acknowledge(request);
      self.send_result(test::result_message(ours, result_t::ACCEPTED));
    }
  });
  Client client(client_options_);
  RemoteCalibration* running = nullptr;
  RemoteCalibration calibration(client, {}, limits_, [&](const status_t& status) {
    if (status.request_id == running->request_id()) running->finish();
  });
  running = &calibration;
  while (!calibration.outcome()) calibration.spin_once(milliseconds(5));
  EXPECT_EQ(calibration.outcome()->kind, Kind::kAccepted);
}

TEST_F(RemoteCalibrationTest, TellsWhyTheRequestWasRefused) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    self.acknowledge(request, status_t::ACK_BUSY, "calibration 5 is running");
  });
  const CalibrationOutcome outcome = run();
  EXPECT_EQ(outcome.kind, Kind::kRequestRefused);
  EXPECT_EQ(outcome.text, "calibration 5 is running");
  ASSERT_TRUE(outcome.acknowledgement.has_value());
  EXPECT_EQ(outcome.acknowledgement->code, +status_t::ACK_BUSY);
}

TEST_F(RemoteCalibrationTest, TellsThatNoDaemonIsThere) {
  limits_.first_status = milliseconds(150);
  EXPECT_EQ(run().kind, Kind::kNoStatus);
}

TEST_F(RemoteCalibrationTest, TellsThatTheDaemonDoesNotAnswer) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon&, const request_t&) {});
  limits_.acknowledgement = milliseconds(300);
  EXPECT_EQ(run().kind, Kind::kNotAcknowledged);
}

TEST_F(RemoteCalibrationTest, GivesUpAtTheTimeLimitAndCancels) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    if (request.action == request_t::START) begin(self, request);
  });
  limits_.total = milliseconds(500);
  const CalibrationOutcome outcome = run();
  EXPECT_EQ(outcome.kind, Kind::kTimedOut);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (daemon.distinct_ids(request_t::CANCEL).empty() &&
         std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_EQ(daemon.distinct_ids(request_t::CANCEL).size(), 1u);
}

TEST_F(RemoteCalibrationTest, WithoutALimitOfItsOwnItWaitsAsLongAsStatusSays) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    begin(self, request);
    self.status().max_duration_s = 0.3;
  });
  limits_.total.reset();
  limits_.solving = milliseconds(200);
  const auto began = std::chrono::steady_clock::now();
  EXPECT_EQ(run().kind, Kind::kTimedOut);
  EXPECT_GE(std::chrono::steady_clock::now() - began, milliseconds(500));
}

TEST_F(RemoteCalibrationTest, TellsThatTheDaemonWasRestarted) {
  auto first = std::make_unique<ScriptedDaemon>(
      provider_, [](ScriptedDaemon& self, const request_t& request) { begin(self, request); });
  Client client(client_options_);
  bool running = false;
  RemoteCalibration calibration(client, {}, limits_, [&](const status_t& status) {
    running = running || status.session_state == status_t::COLLECTING;
  });
  while (!running && !calibration.outcome()) calibration.spin_once(milliseconds(5));
  first.reset();
  ScriptedDaemon second(provider_, [](ScriptedDaemon&, const request_t&) {});
  while (!calibration.outcome()) calibration.spin_once(milliseconds(5));
  EXPECT_EQ(calibration.outcome()->kind, Kind::kDaemonRestarted);
  EXPECT_TRUE(second.distinct_ids(request_t::START).empty());
}

TEST_F(RemoteCalibrationTest, TellsThatTheDaemonFellSilent) {
  auto daemon = std::make_unique<ScriptedDaemon>(
      provider_, [](ScriptedDaemon& self, const request_t& request) { begin(self, request); });
  limits_.silence = milliseconds(300);
  Client client(client_options_);
  bool running = false;
  RemoteCalibration calibration(client, {}, limits_, [&](const status_t& status) {
    running = running || status.session_state == status_t::COLLECTING;
  });
  while (!running && !calibration.outcome()) calibration.spin_once(milliseconds(5));
  daemon.reset();
  while (!calibration.outcome()) calibration.spin_once(milliseconds(5));
  EXPECT_EQ(calibration.outcome()->kind, Kind::kTimedOut);
}

TEST_F(RemoteCalibrationTest, CancelWaitsForTheConfirmation) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    if (request.action == request_t::START) {
      begin(self, request);
    } else if (request.target_request_id == self.status().request_id) {
      self.acknowledge(request);
      self.status().session_state = status_t::CANCELLED;  // without any RESULT
    }
  });
  Client client(client_options_);
  RemoteCalibration* running = nullptr;
  RemoteCalibration calibration(client, {}, limits_, [&](const status_t& status) {
    if (status.session_state == status_t::COLLECTING) running->cancel();
  });
  running = &calibration;
  while (!calibration.outcome()) calibration.spin_once(milliseconds(5));
  EXPECT_EQ(calibration.outcome()->kind, Kind::kCancelled);
  EXPECT_EQ(daemon.distinct_ids(request_t::CANCEL).size(), 1u);
}

TEST_F(RemoteCalibrationTest, CancelBeforeTheDaemonHeardTheStart) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    if (request.action == request_t::CANCEL) {
      self.acknowledge(request, status_t::ACK_NOTHING_TO_DO, "no calibration is running");
    }
  });
  Client client(client_options_);
  RemoteCalibration calibration(client, {}, limits_);
  calibration.cancel();
  while (!calibration.outcome()) calibration.spin_once(milliseconds(5));
  EXPECT_EQ(calibration.outcome()->kind, Kind::kCancelled);
  // The START was sent once, before the CANCEL, and not again.
  EXPECT_LE(daemon.times_heard(calibration.request_id()), 1);
}

TEST_F(RemoteCalibrationTest, AnUnconfirmedCancellationIsNotCalledCancelled) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    if (request.action == request_t::START) begin(self, request);
  });
  limits_.acknowledgement = milliseconds(300);
  Client client(client_options_);
  RemoteCalibration* running = nullptr;
  RemoteCalibration calibration(client, {}, limits_, [&](const status_t& status) {
    if (status.session_state == status_t::COLLECTING) running->cancel();
  });
  running = &calibration;
  while (!calibration.outcome()) calibration.spin_once(milliseconds(5));
  EXPECT_EQ(calibration.outcome()->kind, Kind::kNotAcknowledged);
}

}  // namespace
}  // namespace handeye
