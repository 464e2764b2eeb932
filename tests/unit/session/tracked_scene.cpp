// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/tracked_scene.hpp"

#include <cmath>

#include "daemon/geometry/projection.hpp"

namespace handeye::tracked {
namespace {

constexpr double kDistance_mm = 80;

Pose looking_at_the_middle(const Eigen::Matrix3d& tilt) {
  Pose pose = Pose::Identity();
  pose.linear() = tilt;
  pose.translation() = tilt * Eigen::Vector3d(0, 0, -kDistance_mm);
  return pose;
}

}  // namespace

Pose true_hand_from_eye() {
  return make_pose(Eigen::Quaterniond(0.6, -0.3, 0.7, 0.2), {40, -60, 290});
}

Pose free_motion(double t) {
  const Eigen::Vector3d w(0.30 * std::sin(1.3 * t) + 0.05 * std::sin(3.1 * t),
                          0.28 * std::sin(1.7 * t + 1) + 0.04 * std::sin(4.3 * t),
                          0.25 * std::sin(0.9 * t + 2));
  Pose pose = looking_at_the_middle(exp_so3(w));
  pose.translation() += Eigen::Vector3d(12 * std::sin(1.1 * t), 12 * std::sin(1.9 * t + 0.5),
                                        10 * std::sin(0.7 * t + 1));
  return pose;
}

Pose one_axis_motion(double t) {
  return looking_at_the_middle(
      exp_so3(Eigen::Vector3d(0.3 * std::sin(1.3 * t) + 0.05 * std::sin(3.1 * t), 0, 0)));
}

TrackedScene::TrackedScene(EyeMotion room_from_eye, int points, unsigned seed)
    : room_from_eye_(std::move(room_from_eye)), random_(seed) {
  std::uniform_real_distribution<double> side(-60, 60);
  std::uniform_real_distribution<double> depth(-10, 10);
  for (int i = 0; i < points; ++i) {
    points_room_.emplace_back(side(random_), side(random_), depth(random_));
  }
}

TrackedFrame TrackedScene::frame(std::int64_t index) {
  const double t = static_cast<double>(index) / kFrameRate_hz;
  std::normal_distribution<double> noise_px(0, 0.2);
  TrackedFrame tracked;
  tracked.index = index;
  tracked.timestamp_ns = kStart_ns + static_cast<std::int64_t>(1e9 * (t + kTimeOffset_s));
  const Pose eye_from_room = room_from_eye_(t).inverse();
  for (std::size_t i = 0; i < points_room_.size(); ++i) {
    const Eigen::Vector3d point_eye = eye_from_room * points_room_[i];
    if (point_eye.z() < 10) continue;
    const Eigen::Vector2d pixel = project<double>(kCamera, point_eye);
    if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > 639 || pixel.y() > 479) continue;
    tracked.observations.push_back({static_cast<std::int64_t>(i),
                                    pixel + Eigen::Vector2d(noise_px(random_), noise_px(random_))});
  }
  return tracked;
}

HandSample TrackedScene::hand(std::int64_t index) {
  const double t = static_cast<double>(index) / kTrackerRate_hz;
  std::normal_distribution<double> noise(0, 1);
  const auto noise3 = [&] {
    return Eigen::Vector3d(noise(random_), noise(random_), noise(random_));
  };
  HandSample sample;
  sample.timestamp_ns = kStart_ns + static_cast<std::int64_t>(1e9 * t);
  sample.tracked = true;
  sample.room_from_hand = room_from_eye_(t) * true_hand_from_eye().inverse();
  sample.room_from_hand.linear() =
      sample.room_from_hand.linear() * exp_so3(rad_from_deg(0.06) * noise3());
  sample.room_from_hand.translation() += 0.15 * noise3();
  return sample;
}

}  // namespace handeye::tracked
