// SPDX-License-Identifier: BSD-3-Clause
// Live, what goes wrong with tracker, camera and time: a calibration that it happens to comes out
// right, or is refused, and STATUS tells what happened.
#include <algorithm>

#include <gmock/gmock.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::seconds;

constexpr seconds kCalibrationTimeout{120};
constexpr double kMostRotation_deg = 0.3;
constexpr double kMostTranslation_mm = 2;

class DisturbanceSystem : public RoomTest {
 protected:
  /// What `handeye calibrate` says while the devices are disturbed; null after a failure.
  nlohmann::json calibrate(const std::vector<std::string>& disturbances) {
    if (!room_.start_simulator({.seed = 3, .extra_words = disturbances}) || !room_.start_daemon()) {
      ADD_FAILURE() << "the room did not start";
      return {};
    }
    Process client(room_.client_words("calibrate", {"--json"}));
    if (!room_.listener().spin_until([&] { return client.has_ended(); }, kCalibrationTimeout)) {
      ADD_FAILURE() << "no end";
      return {};
    }
    return parse_json(client.wait(seconds(0))->out);
  }

  void expect_true(const nlohmann::json& result) const {
    const nlohmann::json truth = read_json(room_.path("truth.json"));
    EXPECT_TRUE(near(pose_of(result.at("hand_from_eye")), pose_of(truth.at("hand_from_eye")),
                     kMostRotation_deg, kMostTranslation_mm))
        << result.dump();
  }

  bool heard(const std::function<bool(const status_t&)>& what) const {
    return std::ranges::any_of(room_.listener().statuses(), what);
  }

  mutable Room room_;
};

// Every few seconds again, for nobody knows when the calibration begins and how long it takes.
TEST_F(DisturbanceSystem, AHiddenBodyAndAStalledCameraAreSurvived) {
  const nlohmann::json result = calibrate(
      {"--tracker-disturb", "occlusion@6=2,occlusion@12=2,occlusion@18=2,occlusion@24=2",
       "--camera-disturb", "stall@3=0.5,stall@5=0.5,stall@9=0.5,stall@15=0.5,stall@21=0.5"});
  if (HasFailure()) return;
  EXPECT_EQ(result.value("verdict", ""), "accepted") << result.dump();
  expect_true(result);
  EXPECT_TRUE(heard([](const status_t& status) {
    return status.session_state == status_t::COLLECTING &&
           status.guidance_code == status_t::GUIDE_HAND_HIDDEN;
  }));
  EXPECT_TRUE(heard([](const status_t& status) {
    return status.session_state == status_t::COLLECTING && status.camera.dropped > 0;
  }));
}

TEST_F(DisturbanceSystem, AJumpOfTheTrackersClockIsCounted) {
  const nlohmann::json result =
      calibrate({"--tracker-disturb", "clock-jump@8=0.3,clock-jump@16=-0.3"});
  if (HasFailure()) return;
  if (result.value("verdict", "") == "accepted") {
    expect_true(result);
  } else {
    EXPECT_EQ(result.value("reason", ""), "clock_unstable") << result.dump();
  }
  EXPECT_TRUE(room_.listener().spin_until(
      [&] { return heard([](const status_t& status) { return status.tracker.clock.jumps > 0; }); },
      seconds(30)));
}

}  // namespace
}  // namespace handeye::test
