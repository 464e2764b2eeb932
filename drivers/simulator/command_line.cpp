// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/command_line.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "drivers/simulator/controller_command_line.hpp"
#include "drivers/simulator/world_command_line.hpp"
#include "protocol/bus.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

/// What CLI11 fills in and parse_command_line then understands.
struct RawOptions {
  RawWorldOptions world;
  RawControllerOptions controller;
  std::string camera_out;
  std::string truth_out;
};

void add_output_options(CLI::App& command, RawOptions& raw) {
  command.add_option("--camera-out", raw.camera_out, "Writes the intrinsics (camera.json)")
      ->type_name("FILE");
  command.add_option("--truth-out", raw.truth_out, "Writes the truth (JSON)")->type_name("FILE");
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
  add_world_options(*run, raw.world);
  add_output_options(*run, raw);
  return run;
}

CLI::App* add_record(CLI::App& program, CommandLine& line, RawOptions& raw) {
  CLI::App* record = program.add_subcommand("record", "Both devices into a recording");
  record->add_option("out", line.recording, "A new LCM log (ends in .lcm) or a new folder")
      ->required();
  record->add_option("--duration", line.duration_s, "Seconds")
      ->check(CLI::Range(0.1, 3600.0))
      ->required();
  add_world_options(*record, raw.world);
  add_output_options(*record, raw);
  return record;
}

/// The checks and conversions that go beyond a single option.
void complete(CommandLine& line, const RawOptions& raw, bool seed_given) {
  line.simulator = world_options(raw.world);
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
