// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>

#include "drivers/recording/recording.hpp"

namespace handeye {

/// Writes a plain folder. Arrival times and frame numbers of images have no place in it.
class FolderWriter final : public RecordingWriter {
 public:
  /// Creates the folder (and those above it). Throws InputError.
  explicit FolderWriter(std::filesystem::path folder);
  ~FolderWriter() override;

  void write_frame(std::int64_t timestamp_ns, std::int64_t arrival_ns, std::uint32_t sequence,
                   int width, int height, const std::vector<std::uint8_t>& jpeg) override;
  void write_datagram(std::int64_t arrival_ns, std::string_view bytes) override;
  void close() override;

 private:
  void require(const std::ofstream& file, const std::filesystem::path& path) const;

  std::filesystem::path folder_;
  std::ofstream frames_;
  std::ofstream tracker_;
  std::size_t frames_written_{0};
};

}  // namespace handeye
