// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drivers/simulator/controller.hpp"
#include "drivers/simulator/live.hpp"
#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

struct CommandLine {
  enum class Command { kRun, kRecord };

  Command command{Command::kRun};
  SimulatorOptions simulator;
  double duration_s{0};  ///< run: 0 = until told to stop
  LiveOptions live;      ///< run
  /// run: plays the tracker's controller as well; nothing is tracked until it is told to.
  std::optional<ControllerOptions> controller;
  std::filesystem::path recording;  ///< record
  std::optional<std::filesystem::path> camera_out;
  std::optional<std::filesystem::path> truth_out;
};

/// Reads the command line. Nothing after --help (printed). Throws UsageError, one line.
std::optional<CommandLine> parse_command_line(int argc, char** argv);

}  // namespace handeye::simulator
