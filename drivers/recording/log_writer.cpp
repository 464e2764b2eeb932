// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/log_writer.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "protocol/channels.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

const Channels kChannels;

}  // namespace

LogWriter::LogWriter(std::filesystem::path path, std::int64_t realtime_minus_monotonic_ns)
    : path_(std::move(path)), realtime_minus_monotonic_ns_(realtime_minus_monotonic_ns) {
  log_ = std::make_unique<lcm::LogFile>(path_.string(), "w");
  if (!log_->good()) {
    throw InputError(
        fmt::format("{}: cannot be created: {}", path_.string(), std::strerror(errno)));
  }
}

LogWriter::~LogWriter() {
  try {
    close();
  } catch (const InputError&) {
    // Nobody is left to tell: whoever wants to know calls close().
  }
}

void LogWriter::write_frame(std::int64_t timestamp_ns, std::int64_t arrival_ns,
                            std::uint32_t sequence, int width, int height,
                            const std::vector<std::uint8_t>& jpeg) {
  image_.timestamp_ns = timestamp_ns;
  image_.frame_number = sequence;
  image_.width = width;
  image_.height = height;
  image_.pixel_format = image_t::JPEG;
  image_.stride = 0;
  image_.size = static_cast<std::int32_t>(jpeg.size());
  image_.data = jpeg;
  write(kChannels.frame, arrival_ns, image_);
}

void LogWriter::write_datagram(std::int64_t arrival_ns, std::string_view bytes) {
  datagram_.arrival_ns = arrival_ns;
  datagram_.size = static_cast<std::int32_t>(bytes.size());
  datagram_.data.assign(bytes.begin(), bytes.end());
  write(kChannels.datagram, arrival_ns, datagram_);
}

template <typename Message>
void LogWriter::write(const std::string& channel, std::int64_t arrival_ns, Message& message) {
  if (!log_) throw InputError(fmt::format("{}: already closed", path_.string()));
  message.utime = (arrival_ns + realtime_minus_monotonic_ns_) / 1000;
  buffer_.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
  ++message.seq;

  lcm::LogEvent event{};
  event.timestamp = message.utime;
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(buffer_.size());
  event.data = buffer_.data();
  if (log_->writeEvent(&event) != 0) {
    throw InputError(fmt::format("{}: cannot be written: {}; is the disk full?", path_.string(),
                                 std::strerror(errno)));
  }
}

void LogWriter::close() {
  if (!log_) return;
  // LCM does not look whether the last bytes reach the disk when it closes the file.
  const bool flushed = std::fflush(log_->getFilePtr()) == 0;
  const int error = errno;
  log_.reset();
  if (!flushed) {
    throw InputError(fmt::format("{}: cannot be written: {}; is the disk full?", path_.string(),
                                 std::strerror(error)));
  }
}

}  // namespace handeye
