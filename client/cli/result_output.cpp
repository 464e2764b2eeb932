// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/result_output.hpp"

#include <cstdio>
#include <fstream>

#include "client/cli/result_text.hpp"
#include "client/cli/status_text.hpp"
#include "daemon/session/result_json.hpp"

namespace handeye::cli {
namespace {

bool write_stdout(std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
         std::fflush(stdout) == 0;
}

[[noreturn]] void throw_not_printed() {
  throw InputError("cannot write to the standard output: is its disk full, or is it closed?");
}

}  // namespace

ExitCode print_result(const CalibrationResult& result, const OutputOptions& output,
                      const std::filesystem::path& save) {
  return print_result(result.verdict, to_json(result), result_text(result, output.palette()),
                      output, save);
}

ExitCode print_result(Verdict verdict, const nlohmann::ordered_json& json, const std::string& text,
                      const OutputOptions& output, const std::filesystem::path& save) {
  // A result that cannot be printed is still saved.
  const bool printed = write_stdout(output.json ? dump_json(json) + "\n" : text);
  if (!save.empty()) save_json(save, json);
  if (!printed) throw_not_printed();
  return verdict == Verdict::kAccepted ? ExitCode::kOk : ExitCode::kRefused;
}

void print_text(std::string_view text) {
  if (!write_stdout(text)) throw_not_printed();
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
