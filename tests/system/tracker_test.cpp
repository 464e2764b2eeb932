// SPDX-License-Identifier: BSD-3-Clause
// The tracker's controller, played by the simulator: the daemon starts the tracking where it is
// told to, and never touches it where it is not; `handeye tracker` does as a person says.
#include <csignal>
#include <functional>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

/// Far more than it takes, for a machine that is busy.
constexpr seconds kSoon{30};

/// A simulated tracker with its controller in a room of its own. Frames come slowly: the camera
/// plays no part here.
class TrackerSystem : public RoomTest {
 protected:
  void start_simulator(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{handeye_sim(),
                                   "run",
                                   "--seed",
                                   "2",
                                   "--rate",
                                   "2",
                                   "--width",
                                   "160",
                                   "--height",
                                   "120",
                                   "--tracker-port",
                                   std::to_string(room_.tracker_port()),
                                   "--lcm-url",
                                   room_.lcm_url(),
                                   "--controller",
                                   "--controller-port",
                                   std::to_string(command_port_)};
    words.insert(words.end(), more.begin(), more.end());
    simulator_ = std::make_unique<Process>(words);
    const auto deadline = std::chrono::steady_clock::now() + kSoon;
    const std::string before = "controller on TCP port ";
    while (simulator_->err().find("tracking is off\n") == std::string::npos) {
      ASSERT_FALSE(simulator_->has_ended()) << simulator_->err();
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << simulator_->err();
      std::this_thread::sleep_for(milliseconds(10));
    }
    const std::string said = simulator_->err();
    command_port_ = std::stoi(said.substr(said.find(before) + before.size()));
  }

  /// The configuration's [tracker] section comes before the others in a room's file, so keys can
  /// only be added by writing the section anew.
  void start_daemon(bool start_tracking) {
    room_.write_camera_file(
        R"({"width":160,"height":120,"fx":120,"fy":120,"cx":80,"cy":60,"distortion":[0,0,0,0,0]})");
    config_ = room_.path("tracker.toml");
    write_bytes(
        config_,
        fmt::format("[lcm]\nurl = \"{}\"\n[tracker]\nport = {}\ncontroller = \"127.0.0.1\"\n"
                    "command_port = {}\nstart_tracking = {}\n[camera]\ndriver = \"lcm\"\n"
                    "intrinsics = \"camera.json\"\n",
                    room_.lcm_url(), room_.tracker_port(), command_port_, start_tracking));
    daemon_ = std::make_unique<Process>(std::vector<std::string>{handeyed(), "--config", config_});
    ASSERT_TRUE(wait_for([](const status_t&) { return true; })) << daemon_->err();
  }

  bool wait_for(const std::function<bool(const status_t&)>& condition) {
    const auto& statuses = room_.listener().statuses();
    return room_.listener().spin_until(
        [&] { return !statuses.empty() && condition(statuses.back()); }, kSoon);
  }
  bool wait_for_state(std::int32_t state) {
    return wait_for([state](const status_t& status) { return status.tracker.state == state; });
  }

  Finished tracker(const std::string& action) {
    return run({handeye(), "tracker", action, "--config", config_, "--json"});
  }
  std::string activity() { return parse_json(tracker("status").out).at("activity"); }

  Room room_;
  int command_port_{0};
  std::filesystem::path config_;
  std::unique_ptr<Process> simulator_;
  std::unique_ptr<Process> daemon_;
};

TEST_F(TrackerSystem, TheDaemonStartsTheTrackingAndStopsItInTheEnd) {
  start_simulator();
  start_daemon(true);
  EXPECT_TRUE(wait_for_state(device_status_t::STREAMING)) << daemon_->err();
  EXPECT_EQ(activity(), "measuring");
  daemon_->send_signal(SIGTERM);
  const auto finished = daemon_->wait(kSoon);
  ASSERT_TRUE(finished.has_value()) << "it still runs";
  EXPECT_EQ(finished->exit_code, 0) << finished->err;
  EXPECT_THAT(finished->err, HasSubstr("tracking was started"));
  EXPECT_THAT(finished->err, HasSubstr("tracking was stopped"));
  EXPECT_EQ(activity(), "none");
}

TEST_F(TrackerSystem, ADaemonThatIsNotToldToLeavesTheTrackerAlone) {
  start_simulator();
  start_daemon(false);
  room_.listener().spin_for(seconds(3));
  EXPECT_EQ(activity(), "none");
  const Finished started = tracker("start");
  EXPECT_EQ(started.exit_code, 0) << started.err;
  EXPECT_TRUE(wait_for_state(device_status_t::STREAMING));
  daemon_->send_signal(SIGTERM);
  ASSERT_TRUE(daemon_->wait(kSoon).has_value()) << "it still runs";
  EXPECT_EQ(activity(), "measuring") << "what a person started goes on";
}

TEST_F(TrackerSystem, AStopSilencesTheTracker) {
  start_simulator();
  start_daemon(false);
  EXPECT_EQ(tracker("start").exit_code, 0);
  EXPECT_TRUE(wait_for_state(device_status_t::STREAMING));
  EXPECT_EQ(tracker("stop").exit_code, 0);
  EXPECT_TRUE(wait_for_state(device_status_t::SILENT));
  EXPECT_EQ(parse_json(tracker("stop").out).at("outcome"), "already");
}

TEST_F(TrackerSystem, TheDaemonStartsAgainATrackerThatWasSwitchedOffAndOn) {
  start_simulator();
  start_daemon(true);
  EXPECT_TRUE(wait_for_state(device_status_t::STREAMING));
  simulator_.reset();
  EXPECT_TRUE(wait_for([](const status_t& status) {
    return status.tracker.text.find("Connection refused; next attempt") != std::string::npos;
  })) << room_.listener().statuses().back().tracker.text;
  start_simulator();
  EXPECT_TRUE(wait_for_state(device_status_t::STREAMING)) << daemon_->err();
}

TEST_F(TrackerSystem, StatusTellsWhyTheTrackingCannotBeStarted) {
  start_simulator({"--controller-fault", "busy"});
  start_daemon(true);
  EXPECT_TRUE(wait_for([](const status_t& status) {
    return status.tracker.text.find("192.0.2.7 has the control") != std::string::npos;
  })) << room_.listener().statuses().back().tracker.text;
  const Finished refused = tracker("start");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(parse_json(refused.out).at("accessed_by"), "192.0.2.7");
}

TEST_F(TrackerSystem, ASilentControllerHoldsUpNobody) {
  start_simulator({"--controller-fault", "silent"});
  start_daemon(true);
  room_.listener().spin_for(seconds(3));
  daemon_->send_signal(SIGTERM);
  const auto finished = daemon_->wait(seconds(8));
  ASSERT_TRUE(finished.has_value()) << "it waits for the controller's answer";
  EXPECT_EQ(finished->exit_code, 0) << finished->err;
}

}  // namespace
}  // namespace handeye::test
