// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/controller_command_line.hpp"

#include <vector>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

namespace handeye::simulator {

void add_controller_options(CLI::App& run, RawControllerOptions& raw) {
  CLI::Option* controller = run.add_flag(
      "--controller", raw.wanted,
      "Plays the tracker's controller as well: tracking is off until 'dtrack2 tracking start' "
      "comes over TCP");
  run.add_option("--controller-port", raw.options.port, "Its TCP port; 0: any free one, printed")
      ->check(CLI::Range(0, 65535))
      ->needs(controller)
      ->capture_default_str();
  run.add_option("--controller-address", raw.options.bind_address,
                 "Where it listens; 0.0.0.0: on every address of this machine")
      ->check(CLI::ValidIPV4)
      ->needs(controller)
      ->capture_default_str();
  run.add_option("--controller-fault", raw.fault,
                 "How it misbehaves: closes connections at once (refuse), answers byte by byte "
                 "(slow), with something else (garbage), with an error (error) or not at all "
                 "(silent), or another program has its control (busy)")
      ->check(CLI::IsMember(
          std::vector<std::string>(kControllerFaultNames.begin(), kControllerFaultNames.end())))
      ->needs(controller)
      ->type_name("FAULT");
}

std::optional<ControllerOptions> controller_options(const RawControllerOptions& raw) {
  if (!raw.wanted) return std::nullopt;
  ControllerOptions options = raw.options;
  if (raw.fault) options.fault = controller_fault_from_name(*raw.fault);
  return options;
}

}  // namespace handeye::simulator
