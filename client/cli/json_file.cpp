// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/json_file.hpp"

#include <fmt/format.h>

#include "drivers/recording/file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {

nlohmann::json read_json_object(const std::filesystem::path& path, std::string_view wanted) {
  nlohmann::json json = nlohmann::json::parse(read_whole_file(path), nullptr, false);
  if (!json.is_object()) {
    throw InputError(
        fmt::format("{}: is not a JSON object (NaN and Infinity are no JSON); {} is wanted",
                    path.string(), wanted));
  }
  return json;
}

}  // namespace handeye::cli
