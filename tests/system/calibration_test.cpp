// SPDX-License-Identifier: BSD-3-Clause
// What the product is for, seen from outside: the simulator's devices, the daemon, the command.
#include <algorithm>
#include <set>

#include <gmock/gmock.h>

#include "daemon/sync/pose_buffer.hpp"
#include "drivers/simulator/world.hpp"
#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// The daemon's own limit is 30 s, then it solves.
constexpr seconds kCalibrationTimeout{120};
constexpr double kMostRotation_deg = 0.3;
constexpr double kMostTranslation_mm = 2;
constexpr double kMostPredicted_deg = 1.0;
constexpr double kMostPredicted_mm = 4.0;

class CalibrationSystem : public RoomTest {};

Pose message_pose(const double (&q)[4], const double (&t)[3]) {
  return make_pose({q[0], q[1], q[2], q[3]}, {t[0], t[1], t[2]});
}

/// The result of `handeye calibrate --json` that was accepted; null after a failure.
nlohmann::json accepted_result(const Finished& client) {
  EXPECT_EQ(client.exit_code, 0) << client.err << client.out;
  EXPECT_EQ(client.err, "") << "progress is for terminals";
  nlohmann::json result;
  EXPECT_NO_THROW(result = parse_json(client.out)) << "not one JSON document: " << client.out;
  EXPECT_EQ(result.value("verdict", ""), "accepted") << client.out;
  return result;
}

void expect_true(const nlohmann::json& result, const nlohmann::json& truth) {
  ASSERT_TRUE(result.contains("hand_from_eye") && result["hand_from_eye"].is_object());
  EXPECT_TRUE(near(pose_of(result["hand_from_eye"]), pose_of(truth["hand_from_eye"]),
                   kMostRotation_deg, kMostTranslation_mm));
}

/// Every valid pose is the tracker's, interpolated to the frame, times the result.
void expect_poses_follow_tracker(const Listener& listener, const nlohmann::json& result) {
  // A gap wider than one period of the 60 Hz tracker: LCM lost a TRACKER on its way to this test.
  PoseBuffer hand({.max_gap_ns = 25'000'000});
  for (const tracker_frame_t& frame : listener.tracker_frames()) {
    for (const body_t& body : frame.bodies) {
      if (body.body_id != result["body_id"]) continue;
      hand.push({frame.timestamp_ns, body.tracked != 0, message_pose(body.q_wxyz, body.t_mm)});
    }
  }
  const Pose hand_from_eye = pose_of(result["hand_from_eye"]);
  const auto offset_ns = static_cast<std::int64_t>(1e9 * result["time_offset_s"].get<double>());
  int compared = 0;
  for (const camera_pose_t& pose : listener.poses()) {
    const HandLookup found = hand.lookup(pose.timestamp_ns - offset_ns);
    if (pose.validity != camera_pose_t::VALID || found.status != LookupStatus::kOk) continue;
    ++compared;
    // What was carried beyond the tracker's last sample errs by what the hand did meanwhile.
    const bool predicted = (pose.flags & camera_pose_t::FLAG_PREDICTED) != 0;
    EXPECT_TRUE(near(message_pose(pose.q_wxyz, pose.t_mm), found.room_from_hand * hand_from_eye,
                     predicted ? kMostPredicted_deg : 1e-5, predicted ? kMostPredicted_mm : 1e-5));
    EXPECT_EQ(pose.calibration_request_id, result["request_id"]);
  }
  EXPECT_GE(compared, 20);
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// The poses against where the simulated camera really was. The lever arm of 300 mm turns the
/// tracker's noise of 0.06 deg per axis into half a millimetre on top of the calibration's error.
void expect_poses_true(const Listener& listener, const simulator::World& world) {
  std::vector<double> turned_deg;
  std::vector<double> moved_mm;
  for (const camera_pose_t& pose : listener.poses()) {
    if (pose.validity != camera_pose_t::VALID) continue;
    const double time_s =
        1e-9 * static_cast<double>(pose.timestamp_ns - world.start_ns) - world.camera_delay_s;
    const Pose actual = message_pose(pose.q_wxyz, pose.t_mm);
    const Pose expected = world.room_from_eye(time_s);
    turned_deg.push_back(deg_from_rad(rotation_angle_rad(actual.linear(), expected.linear())));
    moved_mm.push_back((actual.translation() - expected.translation()).norm());
  }
  ASSERT_GE(turned_deg.size(), 20U);
  EXPECT_LT(median(turned_deg), kMostRotation_deg + 0.1);
  EXPECT_LT(median(moved_mm), kMostTranslation_mm + 0.5);
  EXPECT_LT(*std::ranges::max_element(turned_deg), 1);
  EXPECT_LT(*std::ranges::max_element(moved_mm), 6);
}

/// The tracker is gone and the camera goes on: poses keep coming, none of them valid.
void expect_no_valid_pose_without_tracker(Room& room) {
  Listener& listener = room.listener();
  ASSERT_TRUE(listener.last_frame().has_value());
  room.kill_simulator();
  listener.spin_for(milliseconds(300));
  const std::size_t before = listener.poses().size();
  image_t frame = *listener.last_frame();
  constexpr int kFrames = 20;
  for (int i = 0; i < kFrames; ++i) {
    frame.timestamp_ns = monotonic_ns();
    ++frame.frame_number;
    listener.send_frame(frame);
    listener.spin_for(milliseconds(50));
  }
  EXPECT_TRUE(listener.spin_until([&] { return listener.poses().size() >= before + kFrames / 2; },
                                  seconds(10)));
  for (std::size_t i = before; i < listener.poses().size(); ++i) {
    const camera_pose_t& pose = listener.poses()[i];
    EXPECT_NE(pose.validity, camera_pose_t::VALID);
    EXPECT_EQ(pose.q_wxyz[0], 0) << "an invalid pose must not look like one";
  }
  EXPECT_TRUE(listener.spin_until(
      [&] { return listener.statuses().back().tracker.state == device_status_t::SILENT; },
      seconds(10)));
}

TEST_F(CalibrationSystem, GivesTheTrueTransformationAndThenTheCamerasPose) {
  const SimulatorSettings settings{.seed = 3};
  Room room;
  ASSERT_TRUE(room.start_simulator(settings));
  ASSERT_TRUE(room.start_daemon());
  Listener& listener = room.listener();

  Process client(room.client_words("calibrate", {"--json"}));
  ASSERT_TRUE(listener.spin_until([&] { return client.has_ended(); }, kCalibrationTimeout));
  const nlohmann::json result = accepted_result(*client.wait(seconds(0)));
  if (HasFailure()) return;
  const nlohmann::json truth = read_json(room.path("truth.json"));
  expect_true(result, truth);

  listener.hear_poses();
  listener.hear_frames();
  listener.spin_for(seconds(4));
  EXPECT_TRUE(listener.statuses().back().calibrated);
  EXPECT_EQ(listener.statuses().back().calibration_request_id, result["request_id"]);
  expect_poses_follow_tracker(listener, result);
  const simulator::World world({.seed = settings.seed, .camera_rate_hz = settings.camera_rate_hz},
                               truth["start_ns"].get<std::int64_t>());
  ASSERT_TRUE(near(world.hand_from_eye, pose_of(truth["hand_from_eye"]), 1e-9, 1e-9));
  expect_poses_true(listener, world);
  expect_no_valid_pose_without_tracker(room);
}

/// Every request that STATUS of this room ever named.
std::set<std::int64_t> requests_named(const Listener& listener) {
  std::set<std::int64_t> ids;
  for (const status_t& status : listener.statuses()) {
    ids.insert({status.request_id, status.calibration_request_id});
    ids.insert(status.ack_request_id.begin(), status.ack_request_id.end());
  }
  ids.erase(0);
  return ids;
}

TEST_F(CalibrationSystem, FindsTheLensThatNobodyTold) {
  Room room;
  ASSERT_TRUE(room.start_simulator({.seed = 5}));
  ASSERT_TRUE(room.start_daemon(
      {.intrinsics = "",
       .extra_lines = "intrinsics_mode = \"estimate\"\nwidth = 640\nheight = 480\n"}));
  Process client(room.client_words("calibrate", {"--json"}));
  ASSERT_TRUE(room.listener().spin_until([&] { return client.has_ended(); }, kCalibrationTimeout));
  const nlohmann::json result = accepted_result(*client.wait(seconds(0)));
  if (HasFailure()) return;
  const nlohmann::json truth = read_json(room.path("truth.json"));
  expect_true(result, truth);
  const nlohmann::json& lens = result["camera"];
  EXPECT_EQ(lens["source"], "estimated");
  EXPECT_TRUE(lens["observable"].get<bool>());
  const double true_focal_px = truth["camera"]["fx"].get<double>();
  EXPECT_NEAR(lens["fx"].get<double>(), true_focal_px, 0.005 * true_focal_px);
}

TEST_F(CalibrationSystem, TwoRoomsAtATimeDoNotHearEachOther) {
  Room rooms[2];
  std::unique_ptr<Process> clients[2];
  for (std::size_t i = 0; i < 2; ++i) {
    // A low rate: two renderers, two daemons and more share what may be two cores.
    ASSERT_TRUE(rooms[i].start_simulator({.seed = 21 + i, .camera_rate_hz = 12}));
    ASSERT_TRUE(rooms[i].start_daemon({.extra_lines = "[calibration]\nmax_duration_s = 60\n"}));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    clients[i] = std::make_unique<Process>(rooms[i].client_words("calibrate", {"--json"}));
  }
  const auto both_ended = [&] {
    rooms[1].listener().spin_for(milliseconds(10));
    return clients[0]->has_ended() && clients[1]->has_ended();
  };
  ASSERT_TRUE(rooms[0].listener().spin_until(both_ended, kCalibrationTimeout));
  for (std::size_t i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    const nlohmann::json result = accepted_result(*clients[i]->wait(seconds(0)));
    if (result.is_null()) continue;
    expect_true(result, read_json(rooms[i].path("truth.json")));
    EXPECT_THAT(requests_named(rooms[i].listener()),
                testing::ElementsAre(result["request_id"].get<std::int64_t>()));
  }
}

}  // namespace
}  // namespace handeye::test
