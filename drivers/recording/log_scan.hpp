// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/recording/frame_source.hpp"
#include "drivers/recording/recording.hpp"

namespace handeye {

/// What one pass over an LCM log finds.
struct LogContents {
  std::string frame_channel;  ///< the one channel whose name ends in FRAME
  FrameSummary summary;
  std::vector<RecordedDatagram> datagrams;  ///< of the channel whose name ends in DATAGRAM
};

/// Reads the whole log and checks everything but the images' pixels. Throws InputError.
LogContents scan_log(const std::filesystem::path& path);

}  // namespace handeye
