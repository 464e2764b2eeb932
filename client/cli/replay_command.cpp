// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <memory>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

#include "client/cli/commands.hpp"
#include "client/cli/eye_options.hpp"
#include "client/cli/options.hpp"
#include "client/cli/result_output.hpp"
#include "daemon/session/replay.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {
namespace {

struct ReplayCommandOptions {
  OutputOptions output;
  EyeOptions eye;
  ReplayOptions replay;
  std::string intrinsics{intrinsics_word(IntrinsicsMode::kFixed)};
  std::string camera_file;
  std::string mask_file;
  std::filesystem::path save;
};

ExitCode run_replay(ReplayCommandOptions options) {
  options.replay.board = chosen_board(options.eye);
  options.replay.intrinsics = *intrinsics_from_word(options.intrinsics);
  if (options.replay.board && options.replay.intrinsics != IntrinsicsMode::kFixed) {
    throw UsageError(
        "--intrinsics refine and estimate are for --eye sfm; for a board's images use "
        "handeye intrinsics");
  }
  if (!options.camera_file.empty()) options.replay.camera_file = options.camera_file;
  if (!options.mask_file.empty()) options.replay.mask_file = options.mask_file;
  ProgressLine progress;
  options.replay.progress = [&](std::int64_t frames_done) {
    progress.show(
        fmt::format("replaying {}: {} frames", options.replay.recording.string(), frames_done));
  };
  const CalibrationResult result = replay(options.replay);
  progress.clear();
  return print_result(result, options.output, options.save);
}

}  // namespace

void add_replay_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<ReplayCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "replay", "calibrate from a recording, with the daemon's own pipeline; needs no daemon");
  command->add_option("recording", options->replay.recording, "LCM log (.lcm) or folder")
      ->required()
      ->type_name("RECORDING");
  add_eye_options(*command, options->eye);
  command->add_option("--camera", options->camera_file, "intrinsics instead of the recording's")
      ->type_name("FILE");
  command
      ->add_option("--intrinsics", options->intrinsics,
                   "fixed: the lens as given; refine: that is where it starts; estimate: from the "
                   "images alone, no camera file needed")
      ->check(CLI::IsMember({"fixed", "refine", "estimate"}))
      ->capture_default_str();
  command
      ->add_option("--mask", options->mask_file, "mask (white = usable) instead of the recording's")
      ->type_name("FILE");
  command
      ->add_option("--body", options->replay.body_id,
                   "body on the scope, the tracker's number from 0; default: the first one seen")
      ->check(CLI::Range(0, 999))
      ->type_name("N");
  add_sigma_option(
      *command, options->replay.wanted,
      fmt::format("default {},{}", WantedSigma{}.rotation_deg, WantedSigma{}.translation_mm));
  add_save_option(*command, options->save);
  add_output_options(*command, options->output);
  command->footer("Exit code: 0 accepted, 3 refused, 2 files that cannot be used.");
  command->callback([options, &action] { action = [options] { return run_replay(*options); }; });
}

}  // namespace handeye::cli
