// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/truth_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

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

namespace {

constexpr std::string_view timestamps_word(Timestamps timestamps) {
  switch (timestamps) {
    case Timestamps::kUnixTime:
      return "ts2";
    case Timestamps::kNone:
      return "none";
    case Timestamps::kSecondsOfDay:
      break;
  }
  return "ts";
}

/// What was asked for beyond the usual; the file of a simulation without it names none of it.
void add_faults(const World& world, nlohmann::ordered_json& truth) {
  const SimulatorOptions& options = world.options;
  if (!world.tracker_faults.empty()) truth["tracker_faults"] = spelling(world.tracker_faults);
  if (!world.camera_faults.empty()) truth["camera_faults"] = spelling(world.camera_faults);
  if (options.midnight_s) truth["midnight_s"] = *options.midnight_s;
  if (options.timestamps != Timestamps::kSecondsOfDay) {
    truth["timestamps"] = timestamps_word(options.timestamps);
  }
  if (options.covariance) truth["covariance"] = true;
  if (options.head_turn) {
    truth["head_turn"] = spelling(*options.head_turn);
    truth["hand_from_eye_after"] =
        pose_json(world.hand_from_eye_at(std::numeric_limits<double>::infinity()));
  }
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
  add_faults(world, truth);
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
