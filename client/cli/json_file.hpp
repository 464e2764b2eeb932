// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>

namespace handeye::cli {

/// Reads a file that holds one JSON object. `wanted` says in a message what the file should have
/// been: "a result or truth file". Throws InputError, naming the file, for one that cannot be read
/// or holds something else.
nlohmann::json read_json_object(const std::filesystem::path& path, std::string_view wanted);

}  // namespace handeye::cli
