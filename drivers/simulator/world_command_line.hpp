// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// What the command line says of the world: `options` where an option is no more than a number, and
/// what is yet to be understood.
struct RawWorldOptions {
  SimulatorOptions options;
  std::string motion{"free"};
  std::vector<double> amplitude_deg_mm{SimulatorOptions{}.largest_turn_deg,
                                       SimulatorOptions{}.largest_shift_mm};
  std::string scene{"tissue"};
  std::optional<std::string> board;
  std::vector<double> lens_k1_k2;
  std::vector<std::string> disturbances;
  std::vector<double> noise_deg_mm{SimulatorOptions{}.tracker_noise_deg,
                                   SimulatorOptions{}.tracker_noise_mm};
  std::vector<std::string> tracker_faults;
  std::vector<std::string> camera_faults;
  std::string timestamps{"ts"};
  std::optional<std::string> head_turn;
};

/// Everything that a simulated world may differ in. `raw` must outlive the parsing.
void add_world_options(CLI::App& command, RawWorldOptions& raw);

/// Throws UsageError, one line.
SimulatorOptions world_options(const RawWorldOptions& raw);

}  // namespace handeye::simulator
