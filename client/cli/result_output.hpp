// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "client/cli/options.hpp"
#include "daemon/session/result.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {

/// Prints a result as --json and --color say, writes it to `save` unless that is empty, and tells
/// the exit code of its verdict. Throws InputError when either cannot be written.
ExitCode print_result(const CalibrationResult& result, const OutputOptions& output,
                      const std::filesystem::path& save);

/// The same for a result whose JSON and text are made already.
ExitCode print_result(Verdict verdict, const nlohmann::ordered_json& json, const std::string& text,
                      const OutputOptions& output, const std::filesystem::path& save);

/// Writes text to stdout as it stands. Throws InputError when that fails.
void print_text(std::string_view text);

/// Writes a JSON document to a file. Throws InputError when that fails.
void save_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace handeye::cli
