// SPDX-License-Identifier: BSD-3-Clause
// The program against a daemon that follows a script, over real LCM.
#include <algorithm>
#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <handeye/camera_pose_t.hpp>
#include <nlohmann/json.hpp>

#include "tests/unit/client/program_run.hpp"
#include "tests/unit/client/scripted_daemon.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;
using test::Finished;
using test::ProgramRun;
using test::ScriptedDaemon;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Json = nlohmann::json;

class DaemonCommands : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto problem = test::lcm_problem()) GTEST_SKIP() << *problem;
  }

  std::vector<std::string> with_provider(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--lcm-url", provider_});
    return arguments;
  }

  Finished run(const std::vector<std::string>& arguments) const {
    return test::run_handeye(with_provider(arguments));
  }

  /// A daemon that answers every START at once with this verdict.
  ScriptedDaemon::Script answering(std::int32_t verdict) const {
    return [verdict](ScriptedDaemon& self, const request_t& request) {
      self.acknowledge(request);
      self.status().request_id = request.request_id;
      self.status().session_state =
          verdict == result_t::ACCEPTED ? +status_t::DONE : +status_t::REFUSED;
      self.send_result(test::result_message(request.request_id, verdict));
    };
  }

  std::string provider_ = test::private_provider();
};

TEST_F(DaemonCommands, AcceptedIsExitCode0AndOneDocument) {
  const ScriptedDaemon daemon(provider_, answering(result_t::ACCEPTED));
  const test::TemporaryFolder folder;
  const Finished finished = run({"calibrate", "--json", "--body", "3", "--sigma", "0.2,0.8",
                                 "--max-duration", "9", "--save", folder / "result.json"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.err, IsEmpty());
  const Json json = Json::parse(finished.out);
  EXPECT_EQ(json.at("verdict"), "accepted");
  EXPECT_EQ(json.at("hand_from_eye").at("t_mm"), Json({0.0, 0.0, 300.0}));
  EXPECT_EQ(Json::parse(test::read_text(folder / "result.json")), json);

  const request_t start = daemon.requests().front();
  EXPECT_EQ(start.body_id, 3);
  EXPECT_EQ(start.wanted_sigma_rotation_deg, 0.2);
  EXPECT_EQ(start.wanted_sigma_translation_mm, 0.8);
  EXPECT_EQ(start.max_duration_s, 9);
}

TEST_F(DaemonCommands, RefusedIsExitCode3WithTheReason) {
  const ScriptedDaemon daemon(provider_, answering(result_t::REFUSED));
  const Finished finished = run({"calibrate", "--json"});
  EXPECT_EQ(finished.exit_code, 3) << finished.err;
  const Json json = Json::parse(finished.out);
  EXPECT_EQ(json.at("verdict"), "refused");
  EXPECT_EQ(json.at("reason"), "single_axis");
  EXPECT_THAT(run({"calibrate"}).out, HasSubstr("must not be used"));
}

TEST_F(DaemonCommands, ABusyDaemonIsExitCode3) {
  const ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    self.acknowledge(request, status_t::ACK_BUSY, "calibration 5 is running");
  });
  const Finished finished = run({"calibrate", "--json"});
  EXPECT_EQ(finished.exit_code, 3);
  const Json json = Json::parse(finished.out);
  EXPECT_EQ(json.at("reason"), "busy");
  EXPECT_EQ(json.at("advice"), "calibration 5 is running");
  EXPECT_THAT(finished.err, HasSubstr("calibration 5 is running"));
}

TEST_F(DaemonCommands, NoAnswerAfterTheAcknowledgementIsExitCode4) {
  const ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    self.acknowledge(request);
    self.status().request_id = request.request_id;
    self.status().session_state = status_t::COLLECTING;
  });
  const Finished finished = run({"calibrate", "--timeout", "1"});
  EXPECT_EQ(finished.exit_code, 4);
  EXPECT_THAT(finished.out, IsEmpty());
}

TEST_F(DaemonCommands, CtrlCCancelsAndIsExitCode3) {
  std::atomic<bool> collecting{false};
  const ScriptedDaemon daemon(provider_, [&](ScriptedDaemon& self, const request_t& request) {
    self.acknowledge(request);
    if (request.action == request_t::START) {
      self.status().request_id = request.request_id;
      self.status().session_state = status_t::COLLECTING;
      collecting = true;
    } else if (request.target_request_id == self.status().request_id) {
      self.status().session_state = status_t::CANCELLED;
      self.send_result(test::result_message(request.target_request_id, result_t::CANCELLED));
    }
  });
  ProgramRun program(with_provider({"calibrate", "--json"}));
  while (!collecting) std::this_thread::sleep_for(milliseconds(5));
  program.interrupt();
  const Finished finished = program.wait();
  EXPECT_EQ(finished.exit_code, 3) << finished.err;
  EXPECT_EQ(Json::parse(finished.out).at("verdict"), "cancelled");
  EXPECT_EQ(daemon.distinct_ids(request_t::CANCEL).size(), 1u);
}

TEST_F(DaemonCommands, WithoutADaemonItIsExitCode2AndSaysWhatToCheck) {
  // Side by side: each waits some seconds before it gives up.
  ProgramRun status(with_provider({"status", "--json"}));
  ProgramRun calibrate(with_provider({"calibrate", "--json"}));
  ProgramRun cancel(with_provider({"cancel", "--json"}));
  for (ProgramRun* program : {&status, &calibrate, &cancel}) {
    const Finished finished = program->wait();
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_THAT(finished.out, IsEmpty());
    EXPECT_THAT(finished.err, HasSubstr("is handeyed running"));
  }
}

TEST_F(DaemonCommands, StatusIsPrintedForPeopleAndPrograms) {
  const ScriptedDaemon daemon(provider_, [](ScriptedDaemon&, const request_t&) {});
  const Finished text = run({"status"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("handeyed 1.2.3"));
  const Finished json = run({"status", "--json"});
  EXPECT_EQ(json.exit_code, 0);
  EXPECT_EQ(Json::parse(json.out).at("session").at("state"), "idle");
  EXPECT_TRUE(daemon.requests().empty());
}

TEST_F(DaemonCommands, CancelTellsWhetherSomethingRan) {
  bool running = true;
  const ScriptedDaemon daemon(provider_, [&](ScriptedDaemon& self, const request_t& request) {
    if (self.times_heard(request.request_id) > 1) return;
    self.acknowledge(request, running ? +status_t::ACK_TAKEN : +status_t::ACK_NOTHING_TO_DO,
                     running ? "" : "no calibration is running");
    running = false;
  });
  const Finished first = run({"cancel", "--json"});
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_EQ(Json::parse(first.out).at("cancelled"), true);
  const Finished second = run({"cancel"});
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_EQ(second.out, "no calibration is running\n");
}

TEST_F(DaemonCommands, PoseStreamsLines) {
  Bus bus(provider_);
  Publisher<camera_pose_t> publisher(bus, Channels().camera_pose);
  std::atomic<bool> stop{false};
  std::thread sender([&] {
    camera_pose_t pose{};
    while (!stop) {
      pose.q_wxyz[0] = 1;
      pose.t_mm[1] = -2.5;
      ++pose.timestamp_ns;
      publisher.publish(pose);
      std::this_thread::sleep_for(milliseconds(5));
    }
  });
  const Finished json = run({"pose", "--json", "--count", "3"});
  const Finished text = run({"pose", "--count", "2"});
  stop = true;
  sender.join();
  EXPECT_EQ(json.exit_code, 0);
  EXPECT_EQ(std::count(json.out.begin(), json.out.end(), '\n'), 3);
  const Json first = Json::parse(json.out.substr(0, json.out.find('\n')));
  EXPECT_EQ(first.at("validity"), "valid");
  EXPECT_EQ(first.at("room_from_eye").at("t_mm"), Json({0.0, -2.5, 0.0}));
  EXPECT_EQ(first.at("covariance").size(), 6u);
  EXPECT_EQ(first.at("flags"), Json::array());
  EXPECT_EQ(first.at("predicted_s"), 0);
  EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 4);  // two head lines, two poses
}

TEST_F(DaemonCommands, PoseNamesWhatIsNotToBeTrusted) {
  Bus bus(provider_);
  Publisher<camera_pose_t> publisher(bus, Channels().camera_pose);
  std::atomic<bool> stop{false};
  std::thread sender([&] {
    while (!stop) {
      camera_pose_t good{};
      good.q_wxyz[0] = 1;
      good.covariance[0] = good.covariance[7] = 2e-6;
      good.covariance[35] = 0.25;
      good.predicted_s = 0.0125;
      good.flags = +camera_pose_t::FLAG_PREDICTED | +camera_pose_t::FLAG_CALIBRATION_BROKEN;
      publisher.publish(good);
      camera_pose_t hidden{};
      hidden.validity = camera_pose_t::TRACKER_HIDDEN;
      hidden.flags = camera_pose_t::FLAG_CALIBRATION_DOUBTFUL;
      publisher.publish(hidden);
      std::this_thread::sleep_for(milliseconds(5));
    }
  });
  const Finished all = run({"pose", "--json", "--count", "4"});
  const Finished valid = run({"pose", "--json", "--valid-only", "--count", "2"});
  const Finished text = run({"pose", "--valid-only", "--count", "1"});
  stop = true;
  sender.join();
  EXPECT_NE(all.out.find(R"("validity":"tracker_hidden","flags":["calibration_doubtful"])"),
            std::string::npos)
      << all.out;
  EXPECT_EQ(valid.out.find("tracker_hidden"), std::string::npos);
  const Json first = Json::parse(valid.out.substr(0, valid.out.find('\n')));
  EXPECT_EQ(first.at("flags"), Json::array({"predicted", "calibration_broken"}));
  EXPECT_EQ(first.at("predicted_s"), 0.0125);
  EXPECT_NE(text.out.find("0.115 0.500 12.5 predicted,calibration_broken"), std::string::npos)
      << text.out;
}

}  // namespace
}  // namespace handeye
