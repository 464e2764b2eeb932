// SPDX-License-Identifier: BSD-3-Clause
// What cannot work is said in one line, with the documented exit code.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

class BadInputSystem : public RoomTest {
 protected:
  Finished run_daemon(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{handeyed(), "--config", room_.path("handeyed.toml")};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, std::chrono::seconds(30));
  }

  /// Runs the daemon with the configuration and intrinsics as they are; it must not start.
  Finished daemon_with(const DaemonSettings& settings, const std::vector<std::string>& more = {}) {
    room_.write_config(settings);
    return run_daemon(more);
  }
  Finished daemon_with_camera(const std::string& json) {
    room_.write_camera_file(json);
    return daemon_with({});
  }

  Room room_;
};

void expect_one_line(const Finished& finished, int exit_code, const std::string& program,
                     const std::vector<std::string>& words) {
  EXPECT_EQ(finished.exit_code, exit_code);
  EXPECT_THAT(lines_of(finished.err), SizeIs(1)) << finished.err;
  EXPECT_THAT(finished.err, StartsWith(program + ": "));
  for (const std::string& word : words) EXPECT_THAT(finished.err, HasSubstr(word));
  EXPECT_THAT(finished.out, IsEmpty());
}

TEST_F(BadInputSystem, TrackerPortInUse) {
  room_.write_camera_file(kSomeCamera);
  const OccupiedPort occupied;
  const Finished finished = daemon_with({.tracker_port = occupied.number()});
  expect_one_line(finished, 2, "handeyed", {std::to_string(occupied.number()), "in use"});
}

TEST_F(BadInputSystem, ConfigurationMistakeNamesLineAndKey) {
  room_.write_camera_file(kSomeCamera);
  const DaemonSettings misspelt{.extra_lines = "\n[calibration]\nmax_duration = 20\n"};
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--check-config"}}) {
    expect_one_line(daemon_with(misspelt, more), 1, "handeyed",
                    {"handeyed.toml:12", "max_duration"});
  }
  expect_one_line(daemon_with({.extra_lines = "\n[calibration]\nmax_duration_s = -3\n"}), 1,
                  "handeyed", {"handeyed.toml:12", "max_duration_s"});
  expect_one_line(daemon_with({.extra_lines = "\n[calibration\n"}), 1, "handeyed",
                  {"handeyed.toml:11"});
}

TEST_F(BadInputSystem, ConfigurationFileMissing) {
  expect_one_line(run_daemon(), 2, "handeyed", {"handeyed.toml"});
}

TEST_F(BadInputSystem, CheckConfigSaysOk) {
  room_.write_camera_file(kSomeCamera);
  const Finished finished = daemon_with({}, {"--check-config"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.out, HasSubstr("ok"));
  EXPECT_THAT(finished.err, IsEmpty());
}

TEST_F(BadInputSystem, CheckConfigReadsTheCameraFileToo) {
  expect_one_line(daemon_with({}, {"--check-config"}), 2, "handeyed", {"camera.json"});
}

TEST_F(BadInputSystem, UnusableIntrinsics) {
  expect_one_line(daemon_with({}), 2, "handeyed", {"camera.json"});  // missing
  expect_one_line(daemon_with_camera(""), 2, "handeyed", {"camera.json"});
  expect_one_line(
      daemon_with_camera(
          R"({"width":640,"height":480,"fx":0,"fy":500,"cx":320,"cy":240,"distortion":[0,0,0,0]})"),
      2, "handeyed", {"camera.json", "fx"});
  expect_one_line(
      daemon_with_camera(
          R"({"width":640,"height":480,"fx":500,"fy":NaN,"cx":320,"cy":240,"distortion":[0,0,0,0]})"),
      2, "handeyed", {"camera.json"});
  expect_one_line(
      daemon_with_camera(
          R"({"width":640,"height":480,"fx":500,"fy":1e999,"cx":320,"cy":240,"distortion":[0,0,0,0]})"),
      2, "handeyed", {"camera.json"});
}

TEST_F(BadInputSystem, UnusableLcmProvider) {
  room_.write_camera_file(kSomeCamera);
  write_bytes(room_.path("handeyed.toml"),
              "[lcm]\nurl = \"udpm://10.0.0.1:7667?ttl=0\"\n\n[camera]\ndriver = \"lcm\"\n"
              "intrinsics = \"camera.json\"\n");
  expect_one_line(run_daemon(), 2, "handeyed", {"10.0.0.1", "multicast"});
}

TEST_F(BadInputSystem, NoMulticastRoute) {
  if (run({"unshare", "--net", "true"}).exit_code != 0) {
    GTEST_SKIP() << "a network namespace is not permitted here";
  }
  room_.write_camera_file(kSomeCamera);
  room_.write_config();
  const Finished daemon =
      run({"unshare", "--net", handeyed(), "--config", room_.path("handeyed.toml")});
  expect_one_line(daemon, 2, "handeyed", {"ip route"});
  const Finished client = run({"unshare", "--net", handeye(), "status"});
  expect_one_line(client, 2, "handeye", {"ip route"});
  const Finished simulator =
      run({"unshare", "--net", handeye_sim(), "run", "--duration", "1", "--seed", "1"});
  EXPECT_EQ(simulator.exit_code, 2) << simulator.err;
  EXPECT_THAT(simulator.err, HasSubstr("ip route"));
}

TEST_F(BadInputSystem, NoDaemon) {
  expect_one_line(run(room_.client_words("calibrate", {"--json"})), 2, "handeye",
                  {"no STATUS", "handeyed"});
  expect_one_line(run(room_.client_words("status")), 2, "handeye", {"no STATUS"});
}

TEST_F(BadInputSystem, WrongCommandLine) {
  expect_one_line(run({handeye(), "calibrate", "--max-duration", "soon"}), 1, "handeye",
                  {"--max-duration"});
  expect_one_line(run({handeye(), "replay"}), 1, "handeye", {"--help"});
  expect_one_line(run({handeyed(), "--no-such-option"}), 1, "handeyed", {"--no-such-option"});
}

}  // namespace
}  // namespace handeye::test
