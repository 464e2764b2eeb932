// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "client/cli/terminal.hpp"
#include "drivers/dtrack/tracker_commands.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {

/// What `handeye tracker` asked of whom, and what came of it.
struct TrackerAnswer {
  std::string action;  ///< "start", "stop", "status"
  std::string controller;
  std::uint16_t port{0};
  dtrack::CommandReport report;
};

/// 0 as asked, or so before; 2 nobody there, or no DTrack; 3 refused; 4 no answer in time.
ExitCode tracker_exit_code(dtrack::CommandOutcome outcome);

/// "done", "already", "refused", "unreachable", "timed_out", "malformed".
std::string_view tracker_outcome_word(dtrack::CommandOutcome outcome);

nlohmann::ordered_json tracker_json(const TrackerAnswer& answer);

/// For a person, where the exit code is 0; lines end with a newline.
std::string tracker_text(const TrackerAnswer& answer, const Palette& palette);

/// One line, where it is not: the controller, and what it says or does not.
std::string tracker_failure(const TrackerAnswer& answer);

}  // namespace handeye::cli
