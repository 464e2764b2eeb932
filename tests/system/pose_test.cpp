// SPDX-License-Identifier: BSD-3-Clause
// CAMERA_POSE of the running daemon: for every frame, soon, and predicted where it must be.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "tests/system/pose_json.hpp"
#include "tests/system/room.hpp"

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kCalibrationTimeout{120};

class PoseSystem : public RoomTest {};

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// Time from a frame's sending to its pose's, over the frames that both were heard of [ms].
std::vector<double> latencies_ms(const std::map<std::int64_t, std::int64_t>& sent_us,
                                 const std::vector<camera_pose_t>& poses) {
  std::vector<double> latencies;
  for (const camera_pose_t& pose : poses) {
    const auto frame = sent_us.find(pose.timestamp_ns);
    if (frame == sent_us.end()) continue;
    latencies.push_back(1e-3 * static_cast<double>(pose.utime - frame->second));
  }
  return latencies;
}

bool claims_something(const camera_pose_t& pose) {
  for (int axis = 0; axis < 6; ++axis) {
    if (!(pose.covariance[7 * axis] > 0)) return false;
  }
  return true;
}

TEST_F(PoseSystem, EveryFrameGetsItsPoseSoon) {
  Room room;
  ASSERT_TRUE(room.start_simulator({.seed = 3}));
  ASSERT_TRUE(room.start_daemon());
  Listener& listener = room.listener();
  Process client(room.client_words("calibrate", {"--json"}));
  ASSERT_TRUE(listener.spin_until([&] { return client.has_ended(); }, kCalibrationTimeout));
  ASSERT_EQ(client.wait(seconds(0))->exit_code, 0);

  listener.hear_poses();
  listener.hear_frames();
  std::map<std::int64_t, std::int64_t> sent_us;
  listener.spin_until(
      [&] {
        if (const auto& frame = listener.last_frame()) {
          sent_us.emplace(frame->timestamp_ns, frame->utime);
        }
        return false;
      },
      seconds(5));

  int predicted = 0;
  for (const camera_pose_t& pose : listener.poses()) {
    if (pose.validity != camera_pose_t::VALID) continue;
    EXPECT_TRUE(claims_something(pose));
    const bool flagged = (pose.flags & camera_pose_t::FLAG_PREDICTED) != 0;
    EXPECT_EQ(flagged, pose.predicted_s > 0);
    EXPECT_LE(pose.predicted_s, 0.060 + 1e-9) << "predict_ms by default";
    if (flagged) ++predicted;
  }
  const std::vector<double> latencies = latencies_ms(sent_us, listener.poses());
  ASSERT_GE(latencies.size(), 20U);
  RecordProperty("latency_ms", std::to_string(median(latencies)));
  std::cout << "pose after frame: median " << median(latencies) << " ms, " << predicted << " of "
            << listener.poses().size() << " predicted\n";
  // The wait for the tracker's sample, and what a busy machine takes.
  EXPECT_LT(median(latencies), 100);
}

}  // namespace
}  // namespace handeye::test
