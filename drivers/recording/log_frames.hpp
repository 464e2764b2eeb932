// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "drivers/image/grey_decoder.hpp"
#include "drivers/image/image_message.hpp"
#include "drivers/recording/frame_source.hpp"
#include "drivers/recording/lcm_log_reader.hpp"

namespace handeye {

/// The frames of an LCM log that scan_log() has accepted.
class LogFrames final : public FrameSource {
 public:
  LogFrames(const std::filesystem::path& path, std::string frame_channel, FrameSummary summary);

  const FrameSummary& summary() const override { return summary_; }
  bool next(Frame& frame) override;
  void rewind() override { log_.rewind(); }

 private:
  LcmLogReader log_;
  std::string frame_channel_;
  FrameSummary summary_;
  LcmLogEvent event_;
  CheckedImage image_;
  GreyDecoder decoder_;
};

}  // namespace handeye
