// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/world_command_line.hpp"

#include <variant>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

void add_scene_options(CLI::App& command, RawWorldOptions& raw) {
  command.add_option("--seed", raw.options.seed, "Draws everything; default: random, printed");
  command.add_option("--motion", raw.motion, "How the scope is moved")
      ->check(CLI::IsMember({"free", "translation", "rotation", "single-axis", "pivot", "static",
                             "wobble", "pivot-slide", "roll-only"}))
      ->capture_default_str();
  command
      .add_option("--amplitude", raw.amplitude_deg_mm,
                  "Largest turn about and shift along each axis: DEG,MM (a pivot's tilt is fixed)")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(0.0, 25.0))
      ->type_name("DEG,MM")
      ->capture_default_str();
  CLI::Option* scene =
      command.add_option("--scene", raw.scene, "What is looked at; bare: shaded but not textured")
          ->check(CLI::IsMember({"tissue", "plane", "bare"}))
          ->capture_default_str();
  command
      .add_option(
          "--board", raw.board,
          "A flat calibration board instead of tissue: chessboard:COLSxROWS:SQUARE_MM "
          "(inner corners) or charuco:COLSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY (squares). "
          "At 640x480, chessboard:9x6:4 and charuco:8x6:6:4.5:DICT_4X4_50 stay mostly in view")
      ->type_name("BOARD")
      ->excludes(scene);
}

void add_picture_options(CLI::App& command, RawWorldOptions& raw) {
  const auto names = disturbance_names();
  command.add_option("--disturb", raw.disturbances, "Makes the pictures harder; NAME,NAME,... of")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())))
      ->type_name("NAME");
  command
      .add_option("--lens", raw.lens_k1_k2,
                  "Radial distortion K1[,K2] instead of a drawn, mild one")
      ->delimiter(',')
      ->expected(1, 2)
      ->check(CLI::Range(-1.0, 1.0))
      ->type_name("K1[,K2]");
  command
      .add_option("--image-noise", raw.options.image_noise_grey,
                  "Standard deviation of the image noise, grey levels")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
}

void add_device_options(CLI::App& command, RawWorldOptions& raw) {
  command.add_option("--rate", raw.options.camera_rate_hz, "Frames a second")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  command.add_option("--width", raw.options.width, "Image width [px]")
      ->check(CLI::Range(64, 3840))
      ->capture_default_str();
  command.add_option("--height", raw.options.height, "Image height [px]")
      ->check(CLI::Range(48, 2160))
      ->capture_default_str();
  command.add_option("--tracker-rate", raw.options.tracker_rate_hz, "Datagrams a second")
      ->check(CLI::Range(1.0, 500.0))
      ->capture_default_str();
  command.add_option("--noise", raw.noise_deg_mm, "Tracker noise per axis: DEG,MM")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("DEG,MM")
      ->capture_default_str();
  command.add_option("--body-id", raw.options.body_id, "The tracked body's number on the wire")
      ->check(CLI::Range(0, 999))
      ->capture_default_str();
  command
      .add_option("--jpeg-quality", raw.options.jpeg_quality,
                  "Lowered by itself where a frame would exceed 100 kB")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
}

void add_fault_options(CLI::App& command, RawWorldOptions& raw) {
  command.add_option("--tracker-disturb", raw.tracker_faults, tracker_fault_help())
      ->delimiter(',')
      ->type_name("FAULT");
  command.add_option("--camera-disturb", raw.camera_faults, camera_fault_help())
      ->delimiter(',')
      ->type_name("FAULT");
  command
      .add_option("--midnight", raw.options.midnight_s,
                  "So many seconds after the start the tracker's time of day falls back to 0")
      ->check(CLI::Range(0.0, 86400.0))
      ->type_name("SECONDS");
  command
      .add_option("--timestamps", raw.timestamps,
                  "How the tracker tells time: of day (ts), since 1970 (ts2), or not at all")
      ->check(CLI::IsMember({"ts", "ts2", "none"}))
      ->capture_default_str();
  command.add_flag(
      "--covariance", raw.options.covariance,
      "Tracker noise that differs by axis and time, --noise in the mean, and lines that "
      "tell it (6dcov)");
  command
      .add_option("--turn-head", raw.head_turn,
                  "From then on the camera is turned against the scope by so many degrees, about "
                  "its optical axis (roll) unless told otherwise")
      ->type_name("SECONDS:DEG[:roll|tilt|turn]");
}

Board board_from(const std::string& text) {
  auto parsed = parse_board(text);
  if (const auto* problem = std::get_if<std::string>(&parsed)) throw UsageError(*problem);
  return std::get<Board>(parsed);
}

void complete_faults(SimulatorOptions& options, const RawWorldOptions& raw) {
  for (const std::string& text : raw.tracker_faults) {
    options.tracker_faults.push_back(tracker_fault(text));
  }
  for (const std::string& text : raw.camera_faults) {
    options.camera_faults.push_back(camera_fault(text));
  }
  if (raw.timestamps == "ts2") options.timestamps = Timestamps::kUnixTime;
  if (raw.timestamps == "none") options.timestamps = Timestamps::kNone;
  if (raw.head_turn) options.head_turn = parse_head_turn(*raw.head_turn);
}

}  // namespace

void add_world_options(CLI::App& command, RawWorldOptions& raw) {
  add_scene_options(command, raw);
  add_picture_options(command, raw);
  add_device_options(command, raw);
  add_fault_options(command, raw);
}

SimulatorOptions world_options(const RawWorldOptions& raw) {
  SimulatorOptions options = raw.options;
  options.motion = motion_from_name(raw.motion).value();
  options.largest_turn_deg = raw.amplitude_deg_mm.at(0);
  options.largest_shift_mm = raw.amplitude_deg_mm.at(1);
  options.scene = scene_from_name(raw.scene).value();
  if (raw.board) options.board = board_from(*raw.board);
  for (const std::string& name : raw.disturbances) add_disturbance(name, options.disturbances);
  if (!raw.lens_k1_k2.empty()) {
    options.lens = {raw.lens_k1_k2.at(0), raw.lens_k1_k2.size() > 1 ? raw.lens_k1_k2.at(1) : 0.0};
  }
  options.tracker_noise_deg = raw.noise_deg_mm.at(0);
  options.tracker_noise_mm = raw.noise_deg_mm.at(1);
  complete_faults(options, raw);
  return options;
}

}  // namespace handeye::simulator
