// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/result_output.hpp"

#include <cstdio>
#include <fstream>

#include "client/cli/result_text.hpp"
#include "client/cli/status_text.hpp"
#include "daemon/session/result_json.hpp"

namespace handeye::cli {

ExitCode print_result(const CalibrationResult& result, const OutputOptions& output,
                      const std::filesystem::path& save) {
  return print_result(result.verdict, to_json(result), result_text(result, output.palette()),
                      output, save);
}

ExitCode print_result(Verdict verdict, const nlohmann::ordered_json& json, const std::string& text,
                      const OutputOptions& output, const std::filesystem::path& save) {
  if (output.json) {
    print_line(dump_json(json));
  } else {
    std::fputs(text.c_str(), stdout);
  }
  if (!save.empty()) save_json(save, json);
  return verdict == Verdict::kAccepted ? ExitCode::kOk : ExitCode::kRefused;
}

void save_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  std::ofstream stream(file);
  stream << dump_json(json) << '\n';
  stream.close();
  if (!stream) {
    throw InputError("cannot write the result to " + file.string() +
                     ": is the folder there and writable, and the disk not full?");
  }
}

}  // namespace handeye::cli
