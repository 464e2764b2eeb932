// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <handeye/device_status_t.hpp>
#include <handeye/status_t.hpp>
#include <nlohmann/json.hpp>

#include "client/cli/terminal.hpp"

namespace handeye::cli {

/// "idle", "collecting", ...; "state 17" for one this version does not know.
std::string session_state_word(std::int32_t state);

/// "absent", "waiting", "streaming", "silent", "failed".
std::string device_state_word(std::int32_t state);

/// The daemon's state for a person, several lines, the last with its newline.
std::string status_text(const status_t& status, const Palette& palette);

/// The same, complete, for a program.
nlohmann::ordered_json status_json(const status_t& status);

/// One line while a calibration runs: bar, what to do next, uncertainty so far against
/// the wanted.
std::string progress_text(const status_t& status);

/// Writes JSON without ever failing over text that is not UTF-8. indent < 0: on one line.
std::string dump_json(const nlohmann::ordered_json& json, int indent = 2);

}  // namespace handeye::cli
