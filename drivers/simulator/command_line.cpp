// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/command_line.hpp"

#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "drivers/simulator/controller_command_line.hpp"
#include "protocol/bus.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

/// What CLI11 fills in and parse_command_line then understands.
struct RawOptions {
  std::string motion{"free"};
  std::vector<double> amplitude_deg_mm{SimulatorOptions{}.largest_turn_deg,
                                       SimulatorOptions{}.largest_shift_mm};
  std::string scene{"tissue"};
  std::optional<std::string> board;
  std::vector<double> lens_k1_k2;
  std::vector<std::string> disturbances;
  std::vector<double> noise_deg_mm{SimulatorOptions{}.tracker_noise_deg,
                                   SimulatorOptions{}.tracker_noise_mm};
  std::string camera_out;
  std::string truth_out;
  std::vector<std::string> tracker_faults;
  std::vector<std::string> camera_faults;
  std::string timestamps{"ts"};
  std::optional<std::string> head_turn;
  RawControllerOptions controller;
};

void add_scene_options(CLI::App& command, SimulatorOptions& options, RawOptions& raw) {
  command.add_option("--seed", options.seed, "Draws everything; default: random, printed");
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

void add_picture_options(CLI::App& command, SimulatorOptions& options, RawOptions& raw) {
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
      .add_option("--image-noise", options.image_noise_grey,
                  "Standard deviation of the image noise, grey levels")
      ->check(CLI::Range(0.0, 50.0))
      ->capture_default_str();
}

void add_device_options(CLI::App& command, SimulatorOptions& options, RawOptions& raw) {
  command.add_option("--rate", options.camera_rate_hz, "Frames a second")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  command.add_option("--width", options.width, "Image width [px]")
      ->check(CLI::Range(64, 3840))
      ->capture_default_str();
  command.add_option("--height", options.height, "Image height [px]")
      ->check(CLI::Range(48, 2160))
      ->capture_default_str();
  command.add_option("--tracker-rate", options.tracker_rate_hz, "Datagrams a second")
      ->check(CLI::Range(1.0, 500.0))
      ->capture_default_str();
  command.add_option("--noise", raw.noise_deg_mm, "Tracker noise per axis: DEG,MM")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("DEG,MM")
      ->capture_default_str();
  command.add_option("--body-id", options.body_id, "The tracked body's number on the wire")
      ->check(CLI::Range(0, 999))
      ->capture_default_str();
  command
      .add_option("--jpeg-quality", options.jpeg_quality,
                  "Lowered by itself where a frame would exceed 100 kB")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_option("--camera-out", raw.camera_out, "Writes the intrinsics (camera.json)")
      ->type_name("FILE");
  command.add_option("--truth-out", raw.truth_out, "Writes the truth (JSON)")->type_name("FILE");
}

void add_fault_options(CLI::App& command, SimulatorOptions& options, RawOptions& raw) {
  command.add_option("--tracker-disturb", raw.tracker_faults, tracker_fault_help())
      ->delimiter(',')
      ->type_name("FAULT");
  command.add_option("--camera-disturb", raw.camera_faults, camera_fault_help())
      ->delimiter(',')
      ->type_name("FAULT");
  command
      .add_option("--midnight", options.midnight_s,
                  "So many seconds after the start the tracker's time of day falls back to 0")
      ->check(CLI::Range(0.0, 86400.0))
      ->type_name("SECONDS");
  command
      .add_option("--timestamps", raw.timestamps,
                  "How the tracker tells time: of day (ts), since 1970 (ts2), or not at all")
      ->check(CLI::IsMember({"ts", "ts2", "none"}))
      ->capture_default_str();
  command.add_flag(
      "--covariance", options.covariance,
      "Tracker noise that differs by axis and time, --noise in the mean, and lines that "
      "tell it (6dcov)");
  command
      .add_option("--turn-head", raw.head_turn,
                  "From then on the camera is turned against the scope by so many degrees, about "
                  "its optical axis (roll) unless told otherwise")
      ->type_name("SECONDS:DEG[:roll|tilt|turn]");
}

void add_simulator_options(CLI::App& command, SimulatorOptions& options, RawOptions& raw) {
  add_scene_options(command, options, raw);
  add_picture_options(command, options, raw);
  add_device_options(command, options, raw);
  add_fault_options(command, options, raw);
}

CLI::App* add_run(CLI::App& program, CommandLine& line, RawOptions& raw) {
  CLI::App* run = program.add_subcommand("run", "Both devices in real time");
  run->add_option("--duration", line.duration_s, "Seconds; 0: until SIGINT or SIGTERM")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  run->add_option("--tracker-host", line.live.tracker_host, "Where datagrams go")
      ->capture_default_str();
  run->add_option("--tracker-port", line.live.tracker_port, "UDP port there")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  run->add_option("--lcm-url", line.live.lcm_url, "LCM provider of the frames")
      ->capture_default_str();
  run->add_option("--camera-device", line.live.camera_device,
                  "A video device that frames are written to instead, one of v4l2loopback's")
      ->type_name("DEVICE");
  run->add_option("--prefix", line.live.channel_prefix, "Prefix of the LCM channel")
      ->capture_default_str();
  add_controller_options(*run, raw.controller);
  add_simulator_options(*run, line.simulator, raw);
  return run;
}

CLI::App* add_record(CLI::App& program, CommandLine& line, RawOptions& raw) {
  CLI::App* record = program.add_subcommand("record", "Both devices into a recording");
  record->add_option("out", line.recording, "A new LCM log (ends in .lcm) or a new folder")
      ->required();
  record->add_option("--duration", line.duration_s, "Seconds")
      ->check(CLI::Range(0.1, 3600.0))
      ->required();
  add_simulator_options(*record, line.simulator, raw);
  return record;
}

Board board_from(const std::string& text) {
  auto parsed = parse_board(text);
  if (const auto* problem = std::get_if<std::string>(&parsed)) throw UsageError(*problem);
  return std::get<Board>(parsed);
}

void complete_faults(SimulatorOptions& options, const RawOptions& raw) {
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

/// The checks and conversions that go beyond a single option.
void complete(CommandLine& line, const RawOptions& raw, bool seed_given) {
  line.simulator.motion = motion_from_name(raw.motion).value();
  line.simulator.largest_turn_deg = raw.amplitude_deg_mm.at(0);
  line.simulator.largest_shift_mm = raw.amplitude_deg_mm.at(1);
  line.simulator.scene = scene_from_name(raw.scene).value();
  for (const std::string& name : raw.disturbances) {
    add_disturbance(name, line.simulator.disturbances);
  }
  if (!raw.lens_k1_k2.empty()) {
    line.simulator.lens = {raw.lens_k1_k2.at(0),
                           raw.lens_k1_k2.size() > 1 ? raw.lens_k1_k2.at(1) : 0.0};
  }
  if (raw.board) line.simulator.board = board_from(*raw.board);
  line.simulator.tracker_noise_deg = raw.noise_deg_mm.at(0);
  line.simulator.tracker_noise_mm = raw.noise_deg_mm.at(1);
  complete_faults(line.simulator, raw);
  line.controller = controller_options(raw.controller);
  if (!raw.camera_out.empty()) line.camera_out = raw.camera_out;
  if (!raw.truth_out.empty()) line.truth_out = raw.truth_out;
  if (!is_valid_channel_prefix(line.live.channel_prefix)) {
    throw UsageError(fmt::format("--prefix '{}': use up to 40 letters, digits, '_' and '-'",
                                 line.live.channel_prefix));
  }
  constexpr std::int64_t kShortSeeds = 1'000'000'000;  // short enough to be typed again
  if (!seed_given) line.simulator.seed = static_cast<std::uint64_t>(random_id() % kShortSeeds);
}

}  // namespace

std::optional<CommandLine> parse_command_line(int argc, char** argv) {
  CommandLine line;
  RawOptions raw;
  CLI::App program("Simulated tracker (ART DTrack) and endoscope, with known truth", "handeye-sim");
  program.require_subcommand(1);
  const CLI::App* run = add_run(program, line, raw);
  const CLI::App* record = add_record(program, line, raw);
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    program.exit(help);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{}; see handeye-sim --help", error.what()));
  }
  const CLI::App* chosen = run->parsed() ? run : record;
  line.command = run->parsed() ? CommandLine::Command::kRun : CommandLine::Command::kRecord;
  complete(line, raw, chosen->count("--seed") > 0);
  return line;
}

}  // namespace handeye::simulator
