// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <exception>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <handeye/version.hpp>

#include "client/cli/commands.hpp"
#include "client/cli/terminal.hpp"

namespace {

using namespace handeye;
using namespace handeye::cli;

int to_int(ExitCode code) {
  return static_cast<int>(code);
}

/// CLI11 only says that a subcommand is missing, even where one was misspelt.
std::string mistake_in_words(const CLI::ParseError& error, const std::string& first_argument) {
  const bool no_command = error.get_name() == "RequiredError" && !first_argument.starts_with('-');
  if (no_command && !first_argument.empty()) return "no command '" + first_argument + "'";
  std::string text = error.what();
  std::ranges::replace(text, '\n', ' ');
  return text;
}

/// Help and version go to stdout and are no mistake; all else is one line on stderr.
int report_parse_error(const CLI::App& app, const CLI::ParseError& error,
                       const std::string& first_argument) {
  if (error.get_exit_code() == 0) return app.exit(error);
  const auto chosen = app.get_subcommands();
  const std::string command = chosen.empty() ? "" : " " + chosen.front()->get_name();
  const std::string text = mistake_in_words(error, chosen.empty() ? first_argument : "");
  print_error(text + " (see 'handeye" + command + " --help')");
  return to_int(ExitCode::kUsage);
}

int run(const Action& action) {
  try {
    return to_int(action());
  } catch (const UsageError& error) {
    print_error(error.what());
    return to_int(ExitCode::kUsage);
  } catch (const std::exception& error) {
    print_error(error.what());
    return to_int(ExitCode::kInput);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Talks to handeyed, the hand-eye calibration service for tracked endoscopes.",
               "handeye");
  app.set_version_flag("--version", "handeye " + std::string(kVersion), "print the version");
  app.require_subcommand(1);
  Action action;
  add_calibrate_command(app, action);
  add_status_command(app, action);
  add_watch_command(app, action);
  add_cancel_command(app, action);
  add_pose_command(app, action);
  add_record_command(app, action);
  add_replay_command(app, action);
  add_solve_command(app, action);
  add_onestep_command(app, action);
  add_intrinsics_command(app, action);
  add_compare_command(app, action);
  add_tracker_command(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return report_parse_error(app, error, argc > 1 ? argv[1] : "");
  }
  return run(action);
}
