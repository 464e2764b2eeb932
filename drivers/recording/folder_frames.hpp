// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/image/jpeg_decoder.hpp"
#include "drivers/recording/frame_source.hpp"

namespace handeye {

/// The frames of a plain folder: frames.csv and the images it lists (any format OpenCV reads;
/// colour becomes grey). The folder stores no frame numbers, so `sequence` is the row, from 0.
class FolderFrames final : public FrameSource {
 public:
  /// Reads frames.csv, looks whether every image is there, decodes the first. Throws InputError.
  explicit FolderFrames(const std::filesystem::path& folder);

  const FrameSummary& summary() const override { return summary_; }
  bool next(Frame& frame) override;
  void rewind() override { next_ = 0; }

 private:
  struct Row {
    std::int64_t timestamp_ns;
    std::filesystem::path image;
  };

  void read_rows(const std::filesystem::path& folder);
  void read_image(const std::filesystem::path& path, cv::Mat& grey);

  std::vector<Row> rows_;
  FrameSummary summary_;
  std::size_t next_{0};
  std::vector<std::uint8_t> bytes_;
  JpegDecoder jpeg_;
};

}  // namespace handeye
