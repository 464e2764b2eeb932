// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "daemon/config/config.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

/// Keeps the last accepted calibration over restarts, in one JSON file: version, check sum and the
/// result as docs/result.md describes it. What cannot be read with certainty is no calibration:
/// nothing is guessed. Failures are in the log, none is thrown.
class CalibrationStore {
 public:
  /// `file`: empty: keeps nothing.
  explicit CalibrationStore(std::filesystem::path file) : file_(std::move(file)) {}

  /// What was kept, with its age at `now_utime` (CLOCK_REALTIME [us]; nothing where that is before
  /// it was solved: a clock was put back). A file that is damaged, or of another version, is kept
  /// aside as FILE.damaged.
  std::optional<CalibrationResult> load(std::int64_t now_utime) const;

  /// An accepted result with its vintage; on the disk when this returns. False: it could not be.
  bool save(const CalibrationResult& result) const;

  /// Forgets what was kept.
  void remove() const;

  const std::filesystem::path& file() const { return file_; }

 private:
  void keep_aside(const std::string& problem) const;

  std::filesystem::path file_;
};

/// Where the configuration says, else in the first folder of `state_directory` (systemd's
/// STATE_DIRECTORY; may be null). Empty: nowhere.
std::filesystem::path store_file(const Config::Calibration& config, const char* state_directory);

}  // namespace handeye
