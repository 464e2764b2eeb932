// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/truth_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

nlohmann::ordered_json pose_json(const Pose& pose) {
  Eigen::Quaterniond q(pose.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d t = pose.translation();
  return {{"q_wxyz", {q.w(), q.x(), q.y(), q.z()}}, {"t_mm", {t.x(), t.y(), t.z()}}};
}

nlohmann::ordered_json camera_json(const CameraModel& camera) {
  return {{"width", camera.width},
          {"height", camera.height},
          {"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"distortion", camera.distortion},
          {"source", "given"}};
}

}  // namespace

nlohmann::ordered_json truth_json(const World& world) {
  const SimulatorOptions& options = world.options;
  nlohmann::ordered_json truth{
      {"hand_from_eye", pose_json(world.hand_from_eye)},
      {"time_offset_s", world.time_offset_s()},
      {"camera", camera_json(world.camera)},
      {"seed", options.seed},
      {"motion", motion_name(options.motion)},
      {"amplitude", {{"deg", options.largest_turn_deg}, {"mm", options.largest_shift_mm}}},
      {"scene", scene_name(options.scene)},
      {"disturbances", describe(options.disturbances)},
      {"image_noise_grey", options.image_noise_grey},
      {"body_id", options.body_id},
      {"start_ns", world.start_ns},
      {"camera_rate_hz", options.camera_rate_hz},
      {"camera_delay_s", world.camera_delay_s},
      {"tracker_rate_hz", options.tracker_rate_hz},
      {"tracker_latency_s", world.tracker_latency_s},
      {"tracker_jitter_mean_s", world.tracker_jitter_s},
      {"tracker_clock_start_s", world.tracker_clock_start_s},
      {"tracker_clock_offset_s",
       world.tracker_clock_start_s - 1e-9 * static_cast<double>(world.start_ns)},
      {"tracker_clock_drift", world.tracker_clock_drift},
      {"tracker_noise", {{"deg", options.tracker_noise_deg}, {"mm", options.tracker_noise_mm}}},
      {"room_from_surface", pose_json(world.room_from_surface)},
  };
  if (options.board) {
    truth["scene"] = "board";
    truth["board"] = to_string(*options.board);
    truth["room_from_board"] = pose_json(world.room_from_board().value());
  }
  return truth;
}

void write_truth(const std::filesystem::path& path, const World& world) {
  std::ofstream file(path);
  file << truth_json(world).dump(2) << '\n';
  file.close();
  if (!file) {
    throw InputError(fmt::format("{}: cannot be written ({}): choose another place", path.string(),
                                 std::strerror(errno)));
  }
}

}  // namespace handeye::simulator
