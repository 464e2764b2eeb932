// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

#include "client/cli/commands.hpp"
#include "client/cli/options.hpp"
#include "client/cli/status_text.hpp"
#include "client/cli/tracker_output.hpp"
#include "daemon/config/config.hpp"

namespace handeye::cli {
namespace {

constexpr const char* kDaemonsConfig = "/etc/handeyed/handeyed.toml";

struct TrackerOptions {
  std::string action;
  std::string controller;
  std::optional<std::uint16_t> port;
  std::filesystem::path config;  ///< empty: the installed daemon's
  double timeout_s{10};
  OutputOptions output;
};

/// The controller that the daemon's configuration names.
void take_from_config(const TrackerOptions& options, dtrack::CommandOptions& command) {
  const std::filesystem::path file = options.config.empty() ? kDaemonsConfig : options.config;
  if (options.config.empty() && !std::filesystem::exists(file)) {
    throw UsageError(
        "which controller? Name it with --controller ADDRESS, or the daemon's configuration with "
        "--config FILE");
  }
  const Config::Tracker tracker = load_config(file).tracker;
  if (tracker.controller.empty()) {
    throw UsageError(
        file.string() +
        ": [tracker] controller names none; set it there, or use --controller ADDRESS");
  }
  command.controller = tracker.controller;
  command.port = tracker.command_port;
}

dtrack::CommandOptions command_options(const TrackerOptions& options) {
  dtrack::CommandOptions command;
  command.controller = options.controller;
  if (options.controller.empty()) take_from_config(options, command);
  if (options.port) command.port = *options.port;
  command.timeout =
      std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(1e3 * options.timeout_s)));
  return command;
}

dtrack::CommandReport carry_out(const std::string& action, const dtrack::CommandOptions& options) {
  if (action == "start") return dtrack::start_tracking(options);
  if (action == "stop") return dtrack::stop_tracking(options);
  return dtrack::query_tracker(options);
}

ExitCode run_tracker(const TrackerOptions& options) {
  const dtrack::CommandOptions command = command_options(options);
  const TrackerAnswer answer{.action = options.action,
                             .controller = command.controller,
                             .port = command.port,
                             .report = carry_out(options.action, command)};
  const ExitCode code = tracker_exit_code(answer.report.outcome);
  if (options.output.json) {
    print_line(dump_json(tracker_json(answer)));
  } else if (code == ExitCode::kOk) {
    std::fputs(tracker_text(answer, options.output.palette()).c_str(), stdout);
  }
  if (code != ExitCode::kOk) print_error(tracker_failure(answer));
  return code;
}

}  // namespace

void add_tracker_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<TrackerOptions>();
  CLI::App* command = app.add_subcommand(
      "tracker", "start or stop the tracking of the DTrack controller, or tell its state");
  command->add_option("action", options->action, "start, stop or status")
      ->required()
      ->type_name("")
      ->check(CLI::IsMember({"start", "stop", "status"}).description(""));
  CLI::Option* controller =
      command
          ->add_option("--controller", options->controller,
                       "IPv4 address of the controller; default: as the configuration says")
          ->check(CLI::ValidIPV4.description(""))
          ->type_name("ADDRESS");
  command
      ->add_option("--port", options->port,
                   "its TCP port for commands; default: as the configuration says, else 50105")
      ->check(CLI::Range(1, 65535).description(""))
      ->type_name("N");
  command
      ->add_option("--config", options->config,
                   std::string("the daemon's configuration; default: ") + kDaemonsConfig)
      ->type_name("FILE")
      ->excludes(controller);
  command->add_option("--timeout", options->timeout_s, "seconds for everything together")
      ->check(CLI::Range(0.1, 600.0).description(""))
      ->type_name("S")
      ->capture_default_str();
  add_output_options(*command, options->output);
  command->footer(
      "Talks to the controller itself, not to the daemon: connects, acts, and lets go. Tracking "
      "that runs is not started again, and a calibration of the tracker is never disturbed.\n"
      "Exit code: 0 done, or so before; 2 nobody there, or no DTrack; 3 refused, by the controller "
      "or because another program has its control; 4 no answer in time.");
  command->callback([options, &action] { action = [options] { return run_tracker(*options); }; });
}

}  // namespace handeye::cli
