// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/calibration_store.hpp"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include <boost/crc.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/service/atomic_file.hpp"
#include "daemon/service/journal.hpp"
#include "daemon/session/age_text.hpp"
#include "daemon/session/result_from_json.hpp"
#include "daemon/session/result_json.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFormat = "handeyed calibration";
constexpr int kVersion = 1;

/// A flipped bit must not become another pose. Of the compact text, which is the same for the same
/// numbers.
std::uint32_t checksum(const Json& result) {
  const std::string text = result.dump();
  boost::crc_32_type crc;
  crc.process_bytes(text.data(), text.size());
  return crc.checksum();
}

std::string to_text(const CalibrationResult& result) {
  const Json result_json = to_json(result);
  const Json file{{"format", kFormat},
                  {"version", kVersion},
                  {"crc32", checksum(result_json)},
                  {"result", result_json}};
  return file.dump(2) + "\n";
}

/// Throws InputError, or what the JSON library throws.
CalibrationResult from_text(const std::string& text) {
  const Json file = Json::parse(text);
  if (file.at("format") != kFormat) throw InputError("it is no stored calibration");
  if (file.at("version") != kVersion) {
    throw InputError(fmt::format("it is of version {}, this daemon reads {}",
                                 file.at("version").dump(), kVersion));
  }
  const Json& result_json = file.at("result");
  if (file.at("crc32") != checksum(result_json)) throw InputError("its check sum is wrong");
  CalibrationResult result = result_from_json(result_json);
  if (result.verdict != Verdict::kAccepted || !result.has_estimate || !result.vintage) {
    throw InputError("it holds no accepted calibration");
  }
  return result;
}

/// Nothing: there is none. Throws InputError.
std::optional<std::string> read_if_there(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) throw InputError("it cannot be read");
  return text.str();
}

std::optional<double> age_s(std::int64_t solved_utime, std::int64_t now_utime) {
  if (now_utime < solved_utime) return std::nullopt;
  return 1e-6 * static_cast<double>(now_utime - solved_utime);
}

}  // namespace

std::optional<CalibrationResult> CalibrationStore::load(std::int64_t now_utime) const {
  if (file_.empty()) return std::nullopt;
  try {
    const auto text = read_if_there(file_);
    if (!text) return std::nullopt;
    CalibrationResult result = from_text(*text);
    result.vintage = {.solved_utime = result.vintage->solved_utime,
                      .age_s = age_s(result.vintage->solved_utime, now_utime),
                      .restored = true};
    return result;
  } catch (const std::exception& error) {
    keep_aside(error.what());
    return std::nullopt;
  }
}

bool CalibrationStore::save(const CalibrationResult& result) const {
  if (file_.empty()) return false;
  try {
    replace_file(file_, to_text(result));
    return true;
  } catch (const std::exception& error) {
    log_event(Event::kCalibrationNotStored,
              fmt::format("calibration {} will not survive a restart: {}", result.request_id,
                          error.what()),
              {{"REQUEST_ID", std::to_string(result.request_id)}, {"FILE", file_.string()}});
    return false;
  }
}

void CalibrationStore::remove() const {
  std::error_code error;
  if (!file_.empty()) std::filesystem::remove(file_, error);
}

void CalibrationStore::keep_aside(const std::string& problem) const {
  const std::filesystem::path aside = file_.string() + ".damaged";
  std::error_code error;
  std::filesystem::rename(file_, aside, error);
  log_event(Event::kCalibrationNotRestored,
            fmt::format("the stored calibration {} is not used: {}; {}: calibrate again",
                        file_.string(), problem,
                        error ? "it cannot be kept aside, " + error.message()
                              : "it is kept as " + aside.filename().string()),
            {{"FILE", file_.string()}});
}

std::filesystem::path store_file(const Config::Calibration& config, const char* state_directory) {
  if (!config.store.empty()) return config.store;
  if (state_directory == nullptr) return {};
  // systemd separates several with colons.
  const std::string_view all(state_directory);
  const std::string_view first = all.substr(0, all.find(':'));
  if (first.empty()) return {};
  return std::filesystem::path(first) / "last_calibration.json";
}

}  // namespace handeye
