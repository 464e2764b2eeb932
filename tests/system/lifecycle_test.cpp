// SPDX-License-Identifier: BSD-3-Clause
// The daemon begins and ends well, and needs no device for either.
#include <csignal>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

constexpr seconds kSoon{15};
constexpr seconds kStopTimeout{2};

class LifecycleSystem : public RoomTest {};

TEST_F(LifecycleSystem, SigtermEndsAnIdleDaemon) {
  Room room;
  room.write_camera_file(kSomeCamera);
  ASSERT_TRUE(room.start_daemon());
  const auto finished = room.stop_daemon(kStopTimeout);
  ASSERT_TRUE(finished.has_value()) << "it still runs";
  EXPECT_EQ(finished->exit_code, 0) << finished->err;
}

TEST_F(LifecycleSystem, SigtermEndsADaemonThatCollects) {
  Room room;
  ASSERT_TRUE(room.start_simulator({.seed = 5, .camera_rate_hz = 12}));
  ASSERT_TRUE(room.start_daemon());
  ASSERT_TRUE(room.listener().ask(start_request(60)));
  // In the middle of it: a scene has been found, frames are being added.
  ASSERT_TRUE(room.listener().spin_until(
      [&] { return room.listener().statuses().back().frames_collected > 60; }, seconds(60)));
  ASSERT_EQ(room.listener().session_state(), status_t::COLLECTING);
  const auto finished = room.stop_daemon(kStopTimeout);
  ASSERT_TRUE(finished.has_value()) << "it still runs";
  EXPECT_EQ(finished->exit_code, 0) << finished->err;
}

TEST_F(LifecycleSystem, SigtermEndsADaemonThatSolves) {
  Room room;
  ASSERT_TRUE(room.start_simulator({.seed = 5}));
  ASSERT_TRUE(room.start_daemon());
  request_t start = start_request(6);
  start.wanted_sigma_rotation_deg = 1e-3;
  start.wanted_sigma_translation_mm = 1e-3;
  ASSERT_TRUE(room.listener().ask(start));
  ASSERT_TRUE(room.listener().spin_until(
      [&] { return room.listener().session_state() != status_t::COLLECTING; }, seconds(60)));
  // The solve is brought to its end first.
  const auto finished = room.stop_daemon(kSoon);
  ASSERT_TRUE(finished.has_value()) << "it still runs";
  EXPECT_EQ(finished->exit_code, 0) << finished->err;
}

TEST_F(LifecycleSystem, DevicesMayComeLater) {
  const SimulatorSettings simulator{.seed = 3};
  Room room;
  // Only for camera.json; then there is no device.
  ASSERT_TRUE(room.start_simulator(simulator));
  room.kill_simulator();
  ASSERT_TRUE(room.start_daemon());

  const auto opened = [&] {
    return room.listener().statuses().back().camera.text.find("LCM channel") != std::string::npos;
  };
  ASSERT_TRUE(room.listener().spin_until(opened, kSoon));
  const status_t status = room.listener().statuses().back();
  EXPECT_EQ(status.tracker.state, device_status_t::WAITING);
  EXPECT_THAT(status.tracker.text,
              HasSubstr(fmt::format("waiting for packets on port {}", room.tracker_port())));
  EXPECT_EQ(status.tracker.age_s, -1);
  EXPECT_EQ(status.camera.state, device_status_t::WAITING);
  EXPECT_THAT(status.camera.text, HasSubstr("nothing heard"));
  EXPECT_EQ(status.tracked_bodies, "");

  const Finished refused = run(room.client_words("calibrate", {"--json", "--max-duration", "2"}));
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_EQ(parse_json(refused.out).at("verdict"), "refused");
  EXPECT_EQ(parse_json(refused.out).at("reason"), "camera_lost");

  ASSERT_TRUE(room.start_simulator(simulator));
  const auto streaming = [&] {
    const status_t& now = room.listener().statuses().back();
    return now.tracker.state == device_status_t::STREAMING &&
           now.camera.state == device_status_t::STREAMING && now.tracked_bodies == "0";
  };
  ASSERT_TRUE(room.listener().spin_until(streaming, kSoon));
  const Finished accepted = run(room.client_words("calibrate", {"--json"}));
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err << accepted.out;
}

TEST_F(LifecycleSystem, ADeviceThatFallsSilentIsCalledSoAndTakenBack) {
  const SimulatorSettings simulator{.seed = 6, .camera_rate_hz = 12};
  Room room;
  ASSERT_TRUE(room.start_simulator(simulator));
  ASSERT_TRUE(room.start_daemon());
  const auto both = [&](std::int32_t state) {
    return room.listener().spin_until(
        [&] {
          const status_t& now = room.listener().statuses().back();
          return now.tracker.state == state && now.camera.state == state;
        },
        kSoon);
  };
  EXPECT_TRUE(both(device_status_t::STREAMING));
  room.kill_simulator();
  EXPECT_TRUE(both(device_status_t::SILENT));
  EXPECT_GT(room.listener().statuses().back().camera.age_s, 1);
  ASSERT_TRUE(room.start_simulator(simulator));
  EXPECT_TRUE(both(device_status_t::STREAMING));
}

TEST_F(LifecycleSystem, ImagesOfAnotherSizeThanTheIntrinsicsAreAFault) {
  Room room;
  ASSERT_TRUE(room.start_simulator({.seed = 5, .camera_rate_hz = 12}));
  room.write_camera_file(
      R"({"width":800,"height":600,"fx":500,"fy":500,"cx":400,"cy":300,"distortion":[0,0,0,0,0]})");
  ASSERT_TRUE(room.start_daemon());
  ASSERT_TRUE(room.listener().spin_until(
      [&] { return room.listener().statuses().back().camera.state == device_status_t::FAILED; },
      kSoon));
  const std::string text = room.listener().statuses().back().camera.text;
  EXPECT_THAT(text, HasSubstr("640x480"));
  EXPECT_THAT(text, HasSubstr("800x600"));
}

}  // namespace
}  // namespace handeye::test
