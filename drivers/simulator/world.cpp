// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/world.hpp"

#include <algorithm>
#include <cmath>

namespace handeye::simulator {
namespace {

constexpr double kSecondsADay = 86400.0;
constexpr double kLeverArmMm = 300.0;

/// A mild endoscope lens; its field of view is the same for every image size of one shape.
CameraModel draw_camera(const SimulatorOptions& options) {
  RandomStream random(options.seed, Purpose::kCamera);
  const double scale = options.width / 640.0;
  CameraModel camera;
  camera.width = options.width;
  camera.height = options.height;
  camera.fx = scale * random.uniform(585.0, 615.0);
  camera.fy = camera.fx * random.uniform(0.998, 1.002);
  camera.cx = 0.5 * (options.width - 1) + scale * random.uniform(-8.0, 8.0);
  camera.cy = 0.5 * (options.height - 1) + scale * random.uniform(-8.0, 8.0);
  camera.distortion[0] = random.uniform(-0.12, -0.06);
  camera.distortion[1] = random.uniform(0.0, 0.03);
  if (options.lens) std::ranges::copy(*options.lens, camera.distortion.begin());
  return camera;
}

/// The body is clipped on some 300 mm behind the tip, around the scope's axis, turned anyhow.
Pose draw_hand_from_eye(std::uint64_t seed) {
  RandomStream random(seed, Purpose::kHandEye);
  const double length_mm = kLeverArmMm * random.uniform(0.95, 1.05);
  const double off_axis = rad_from_deg(random.uniform(3.0, 15.0));
  const double around = random.uniform(0.0, 2 * kPi);
  const Eigen::Vector3d hand_in_eye =
      length_mm * Eigen::Vector3d(std::sin(off_axis) * std::cos(around),
                                  std::sin(off_axis) * std::sin(around), -std::cos(off_axis));
  const Eigen::Quaterniond rotation = random.rotation();
  return make_pose(rotation, -(rotation * hand_in_eye));
}

Pose draw_room_from_surface(std::uint64_t seed) {
  RandomStream random(seed, Purpose::kRoom);
  const Eigen::Quaterniond rotation = random.rotation();
  const double x_mm = random.uniform(-500.0, 500.0);
  const double y_mm = random.uniform(-500.0, 500.0);
  return make_pose(rotation, {x_mm, y_mm, random.uniform(900.0, 1300.0)});
}

Surface surface_of(const SimulatorOptions& options) {
  return options.board ? Surface(*options.board) : Surface(options.seed, options.scene);
}

MotionOptions motion_options(const SimulatorOptions& options) {
  return {.kind = options.motion,
          .rotation_deg = options.largest_turn_deg,
          .shift_mm = options.largest_shift_mm};
}

}  // namespace

World::World(const SimulatorOptions& chosen, std::int64_t start)
    : options(chosen),
      start_ns(start),
      camera(draw_camera(chosen)),
      surface(surface_of(chosen)),
      motion(chosen.seed, {0, 0, surface.height(0, 0)}, motion_options(chosen)),
      room_from_surface(draw_room_from_surface(chosen.seed)),
      hand_from_eye(draw_hand_from_eye(chosen.seed)),
      tracker_faults(with_times(chosen.tracker_faults, chosen.seed)),
      camera_faults(with_times(chosen.camera_faults, ~chosen.seed)) {
  RandomStream random(chosen.seed, Purpose::kClocks);
  tracker_latency_s = random.uniform(0.005, 0.025);
  tracker_clock_start_s = random.uniform(0.0, kSecondsADay);
  tracker_clock_drift = random.uniform(-50e-6, 50e-6);
  camera_delay_s = random.uniform(0.010, 0.060);
  if (chosen.midnight_s) {
    tracker_clock_start_s = kSecondsADay - (1.0 + tracker_clock_drift) * *chosen.midnight_s;
  }
}

Pose World::surface_from_eye(double time_s) const {
  const Pose surface_from_old_eye = motion.surface_from_eye(time_s);
  return options.head_turn ? surface_from_old_eye * old_eye_from_eye(*options.head_turn, time_s)
                           : surface_from_old_eye;
}

Pose World::room_from_eye(double time_s) const {
  return room_from_surface * surface_from_eye(time_s);
}

Pose World::room_from_hand(double time_s) const {
  return room_from_surface * motion.surface_from_eye(time_s) * hand_from_eye.inverse();
}

Pose World::hand_from_eye_at(double time_s) const {
  return options.head_turn ? hand_from_eye * old_eye_from_eye(*options.head_turn, time_s)
                           : hand_from_eye;
}

std::optional<Pose> World::room_from_board() const {
  const auto surface_from_board = surface.surface_from_board();
  return surface_from_board ? std::optional<Pose>(room_from_surface * *surface_from_board)
                            : std::nullopt;
}

double World::tracker_clock_s(double time_s) const {
  const double of_day_s = std::fmod(tracker_day_s(time_s), kSecondsADay);
  return of_day_s < 0 ? of_day_s + kSecondsADay : of_day_s;
}

double World::tracker_day_s(double time_s) const {
  return tracker_clock_start_s + (1.0 + tracker_clock_drift) * time_s +
         sum_until(tracker_faults, FaultKind::kClockJump, time_s);
}

std::int64_t World::host_ns(double time_s) const {
  return start_ns + std::llround(time_s * 1e9);
}

}  // namespace handeye::simulator
