// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace handeye {

/// One event of an LCM log.
struct LcmLogEvent {
  std::int64_t number{0};        ///< counted by us, from 0
  std::int64_t offset_bytes{0};  ///< where in the file it begins
  std::int64_t timestamp_us{0};  ///< as the log has it; its epoch is the writer's choice
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// Reads an LCM event log strictly. LCM's own reader answers the same to the clean end of a file
/// and to a file cut short or damaged, so the events are walked here: each is a sync word, the
/// event's number, a time, two lengths (all big-endian), the channel and the data.
class LcmLogReader {
 public:
  /// Throws InputError when the file is not there or cannot be read.
  explicit LcmLogReader(std::filesystem::path path);

  /// Reads the next event into `event`, whose memory is reused. False at the clean end of the file.
  /// Throws InputError where the file is cut short or is no log.
  bool next(LcmLogEvent& event);

  /// Back to the first event.
  void rewind();

  const std::filesystem::path& path() const { return path_; }

 private:
  void read(void* target, std::int64_t bytes);

  std::filesystem::path path_;
  std::ifstream file_;
  std::int64_t file_bytes_{0};
  std::int64_t position_{0};
  std::int64_t events_read_{0};
};

}  // namespace handeye
