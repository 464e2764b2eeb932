// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <memory>

#include <CLI/Error.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

#include "client/cli/commands.hpp"
#include "client/cli/methods_table.hpp"
#include "client/cli/options.hpp"
#include "client/cli/result_output.hpp"
#include "client/cli/solve_json.hpp"
#include "client/cli/solve_text.hpp"
#include "daemon/session/pose_solve.hpp"
#include "drivers/recording/pose_file.hpp"

namespace handeye::cli {
namespace {

constexpr const char* kAll = "all";

struct SolveCommandOptions {
  OutputOptions output;
  PoseSolveOptions solve;
  std::filesystem::path poses;
  std::string scale{"unknown"};
  std::string method{kAll};
  std::filesystem::path save;
};

ExitCode run_solve(SolveCommandOptions options) {
  options.solve.scale = options.scale == "known" ? ScaleMode::kKnown : ScaleMode::kUnknown;
  if (options.method != kAll) options.solve.method = options.method;
  std::vector<PosePair> poses;
  for (const PoseRow& row : read_pose_file(options.poses)) {
    poses.push_back({row.room_from_hand, row.eye_from_scene});
  }
  if (poses.empty()) {
    throw InputError(options.poses.string() +
                     ": has no rows below the header; three poses are the least");
  }
  const PoseSolution solution = solve_poses(poses, options.solve);
  return print_result(solution.calibration.verdict, solve_json(solution),
                      solve_text(solution, options.output.palette()), options.output, options.save);
}

void add_noise_option(CLI::App& command, const std::string& device,
                      std::optional<DeviceNoise>& noise) {
  const auto set = [&noise](double deg, double mm) { noise = DeviceNoise{deg, mm}; };
  add_deviation_option(command, "--" + device + "-noise", set,
                       "standard deviation of the " + device +
                           "'s poses per axis; default: estimated from the residuals");
}

}  // namespace

void add_solve_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<SolveCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "solve", "hand-eye calibration from poses by every method; needs no daemon");
  command
      ->add_option("poses", options->poses,
                   "CSV with the header " + std::string(kPoseFileHeader) +
                       ": room_from_hand [mm] and eye_from_scene, row by row")
      ->required()
      ->type_name("POSES.csv");
  command
      ->add_option("--scale", options->scale,
                   "known: the eye's translations are in mm too (a pattern); unknown: in units of "
                   "their own")
      ->check(CLI::IsMember({"known", "unknown"}))
      ->capture_default_str();
  command
      ->add_option(
          "--method", options->method,
          "all, or only one beside the answer, which is maximum_likelihood: " + method_names())
      ->type_name("NAME")
      ->capture_default_str();
  add_noise_option(*command, "hand", options->solve.hand_noise);
  add_noise_option(*command, "eye", options->solve.eye_noise);
  add_sigma_option(
      *command, options->solve.wanted,
      fmt::format("default {},{}", WantedSigma{}.rotation_deg, WantedSigma{}.translation_mm));
  // As --version does: prints and ends before the options that are required are asked for.
  command->add_flag_callback(
      "--list-methods", [] { throw CLI::CallForVersion(methods_table(), 0); },
      "print the table of methods");
  add_save_option(*command, options->save);
  add_output_options(*command, options->output);
  command->footer("Exit code: 0 accepted, 3 refused, 2 a file that cannot be used.");
  command->callback([options, &action] { action = [options] { return run_solve(*options); }; });
}

}  // namespace handeye::cli
