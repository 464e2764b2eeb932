// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/log_frames.hpp"

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye {

LogFrames::LogFrames(const std::filesystem::path& path, std::string frame_channel,
                     FrameSummary summary)
    : log_(path), frame_channel_(std::move(frame_channel)), summary_(summary) {}

bool LogFrames::next(Frame& frame) {
  do {
    if (!log_.next(event_)) return false;
  } while (event_.channel != frame_channel_);
  if (image_.decode(event_.data.data(), 0, static_cast<int>(event_.data.size())) < 0 ||
      !decoder_.decode(encoded_image(image_), frame.grey)) {
    throw InputError(fmt::format("{}: event {} (byte {}): the image is damaged; record anew",
                                 log_.path().string(), event_.number, event_.offset_bytes));
  }
  frame.timestamp_ns = image_.timestamp_ns;
  frame.arrival_ns = image_.timestamp_ns;
  frame.sequence = static_cast<std::uint32_t>(image_.frame_number);
  return true;
}

}  // namespace handeye
