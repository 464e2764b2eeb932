// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <handeye/status_t.hpp>
#include <nlohmann/json.hpp>

#include "client/cli/status_words.hpp"
#include "client/cli/terminal.hpp"

namespace handeye::cli {

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
