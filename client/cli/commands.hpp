// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <CLI/App.hpp>

#include "protocol/exit_codes.hpp"

namespace handeye::cli {

/// What the chosen subcommand does; set while the command line is parsed, run by main afterwards.
/// May throw InputError and UsageError.
using Action = std::function<ExitCode()>;

/// Each adds its subcommand with its options to the program.
void add_calibrate_command(CLI::App& app, Action& action);
void add_status_command(CLI::App& app, Action& action);
void add_watch_command(CLI::App& app, Action& action);
void add_cancel_command(CLI::App& app, Action& action);
void add_pose_command(CLI::App& app, Action& action);
void add_record_command(CLI::App& app, Action& action);
void add_replay_command(CLI::App& app, Action& action);
void add_solve_command(CLI::App& app, Action& action);
void add_onestep_command(CLI::App& app, Action& action);
void add_intrinsics_command(CLI::App& app, Action& action);
void add_compare_command(CLI::App& app, Action& action);
void add_tracker_command(CLI::App& app, Action& action);

}  // namespace handeye::cli
