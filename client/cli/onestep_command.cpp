// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <memory>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

#include "client/cli/commands.hpp"
#include "client/cli/onestep_input.hpp"
#include "client/cli/onestep_output.hpp"
#include "client/cli/options.hpp"
#include "client/cli/result_output.hpp"

namespace handeye::cli {
namespace {

struct OnestepCommandOptions {
  OutputOptions output;
  std::filesystem::path observations;
  std::filesystem::path start;
  std::string distortion{"inside"};
  std::filesystem::path save;
};

ExitCode run_onestep(const OnestepCommandOptions& options) {
  const Observations observations = read_observations(options.observations);
  PerspectiveOptions how{.distortion_inside = options.distortion == "inside"};
  if (!options.start.empty()) how.start = read_start(options.start, observations);
  const auto result = calibrate_perspective(observations, how);
  const Palette palette = options.output.palette();
  if (const auto* refusal = std::get_if<PerspectiveRefusal>(&result)) {
    return print_result(Verdict::kRefused, onestep_json(*refusal), onestep_text(*refusal, palette),
                        options.output, options.save);
  }
  const auto& calibration = std::get<PerspectiveCalibration>(result);
  return print_result(Verdict::kAccepted, onestep_json(calibration, observations),
                      onestep_text(calibration, observations, palette), options.output,
                      options.save);
}

}  // namespace

void add_onestep_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<OnestepCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "onestep",
      "camera and hand-eye calibration in one step from points of a known object; needs no daemon");
  command
      ->add_option("observations", options->observations,
                   "2-D/3-D correspondences and hand pose of each position")
      ->required()
      ->type_name("OBSERVATIONS.json");
  command
      ->add_option("--distortion", options->distortion,
                   "inside: radial distortion is estimated with the rest; none: the lens is taken "
                   "to have none")
      ->check(CLI::IsMember({"none", "inside"}))
      ->capture_default_str();
  command
      ->add_option("--start", options->start,
                   "where the iteration begins, e.g. an earlier result; default: found from the "
                   "observations")
      ->type_name("FILE");
  add_save_option(*command, options->save);
  add_output_options(*command, options->output);
  command->footer("Exit code: 0 accepted, 3 refused, 2 a file that cannot be used.");
  command->callback([options, &action] { action = [options] { return run_onestep(*options); }; });
}

}  // namespace handeye::cli
