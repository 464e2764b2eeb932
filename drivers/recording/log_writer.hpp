// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <handeye/datagram_t.hpp>
#include <handeye/image_t.hpp>
#include <lcm/lcm-cpp.hpp>

#include "drivers/recording/recording.hpp"

namespace handeye {

/// Writes an LCM event log with the default channel prefix. The same input gives the same bytes: an
/// event's time and the message's utime are its arrival on the given clock, and session_id is 0.
class LogWriter final : public RecordingWriter {
 public:
  /// Throws InputError when the file cannot be created.
  LogWriter(std::filesystem::path path, std::int64_t realtime_minus_monotonic_ns);
  ~LogWriter() override;

  void write_frame(std::int64_t timestamp_ns, std::int64_t arrival_ns, std::uint32_t sequence,
                   int width, int height, const std::vector<std::uint8_t>& jpeg) override;
  void write_datagram(std::int64_t arrival_ns, std::string_view bytes) override;
  void close() override;

 private:
  template <typename Message>
  void write(const std::string& channel, std::int64_t arrival_ns, Message& message);

  std::filesystem::path path_;
  std::int64_t realtime_minus_monotonic_ns_;
  std::unique_ptr<lcm::LogFile> log_;  ///< empty once closed
  image_t image_{};
  datagram_t datagram_{};
  std::vector<std::uint8_t> buffer_;
};

}  // namespace handeye
