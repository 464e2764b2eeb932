// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <CLI/App.hpp>

#include "drivers/simulator/controller.hpp"

namespace handeye::simulator {

/// What the command line says of the controller.
struct RawControllerOptions {
  bool wanted{false};
  ControllerOptions options;  ///< without the fault
  std::optional<std::string> fault;
};

/// --controller and what goes with it. `raw` must outlive the parsing.
void add_controller_options(CLI::App& run, RawControllerOptions& raw);

/// Nothing: no controller is wanted.
std::optional<ControllerOptions> controller_options(const RawControllerOptions& raw);

}  // namespace handeye::simulator
