// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/controller_answers.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace handeye::simulator {
namespace {

/// The words are the simulator's own, and so are the numbers: the real ones are not known.
std::string error(int code, std::string_view text) {
  return fmt::format("dtrack2 err {} \"{}\"", code, text);
}

}  // namespace

std::optional<ControllerFault> controller_fault_from_name(std::string_view name) {
  const auto found = std::ranges::find(kControllerFaultNames, name);
  if (found == kControllerFaultNames.end()) return std::nullopt;
  return static_cast<ControllerFault>(found - kControllerFaultNames.begin());
}

std::string ControllerAnswers::answer(std::string_view command, bool full_access,
                                      std::string_view owner) {
  if (command == "dtrack2 get system access") {
    return fmt::format("dtrack2 set system access {}", full_access ? "full" : "none");
  }
  if (command == "dtrack2 get system accessed_by") {
    return fmt::format("dtrack2 set system accessed_by {}", owner);
  }
  // Who came later may ask these two, nothing else.
  if (!full_access) return error(3, "no access to the system");
  if (command == "dtrack2 get status active") {
    return fmt::format("dtrack2 set status active {}", tracking_ ? "mea" : "none");
  }
  if (command == "dtrack2 tracking start") return start_or_stop(true);
  if (command == "dtrack2 tracking stop") return start_or_stop(false);
  if (command.starts_with("dtrack2 ")) return error(1, "unknown command or parameter");
  return error(2, "syntax error");
}

std::string ControllerAnswers::start_or_stop(bool start) {
  if (tracking_.exchange(start) != start) return "dtrack2 ok";
  return error(4, start ? "tracking is running already" : "tracking is not running");
}

}  // namespace handeye::simulator
