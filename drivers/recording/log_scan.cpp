// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/log_scan.hpp"

#include <optional>

#include <fmt/format.h>
#include <handeye/datagram_t.hpp>

#include "drivers/image/image_message.hpp"
#include "drivers/recording/lcm_log_reader.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::int32_t kMaxDatagramBytes = 65507;

[[noreturn]] void fail(const std::filesystem::path& path, const LcmLogEvent& event,
                       const std::string& what) {
  throw InputError(fmt::format("{}: event {} (channel {}, byte {}): {}; record anew", path.string(),
                               event.number, event.channel, event.offset_bytes, what));
}

/// datagram_t, decoded only when its length field agrees with the message: the generated decode()
/// resizes to whatever length is claimed.
std::optional<datagram_t> decode_datagram(const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kFixedBytes = 8 + 4 * 8 + 4;  // fingerprint, four int64_t, size
  if (bytes.size() < kFixedBytes) return std::nullopt;
  const std::size_t data_bytes = bytes.size() - kFixedBytes;
  std::size_t size = 0;
  for (std::size_t i = kFixedBytes - 4; i < kFixedBytes; ++i) size = size << 8 | bytes[i];
  datagram_t datagram;
  if (size != data_bytes || datagram.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) {
    return std::nullopt;
  }
  return datagram;
}

/// One pass over a log: takes event after event and checks each against those before it.
class Scan {
 public:
  explicit Scan(const std::filesystem::path& path) : path_(path) {}

  void take(const LcmLogEvent& event) {
    if (event.channel.ends_with("FRAME")) {
      require_one_channel(event, contents_.frame_channel);
      take_frame(event);
    } else if (event.channel.ends_with("DATAGRAM")) {
      require_one_channel(event, datagram_channel_);
      take_datagram(event);
    }
  }

  LogContents finish() {
    FrameSummary& summary = contents_.summary;
    if (summary.frames == 0) {
      throw InputError(fmt::format(
          "{}: no camera images in it (no channel ends in FRAME); record with the camera running",
          path_.string()));
    }
    if (summary.frames > 1) {
      summary.rate_hz = static_cast<double>(summary.frames - 1) * 1e9 /
                        static_cast<double>(last_timestamp_ns_ - first_timestamp_ns_);
    }
    return std::move(contents_);
  }

 private:
  void require_one_channel(const LcmLogEvent& event, std::string& channel) {
    if (channel.empty()) channel = event.channel;
    if (channel != event.channel) {
      fail(path_, event, "the log holds " + channel + " too, and only one of a kind is possible");
    }
  }

  void take_frame(const LcmLogEvent& event) {
    if (image_.decode(event.data.data(), 0, static_cast<int>(event.data.size())) < 0) {
      fail(path_, event, "not an image_t");
    }
    if (const auto problem = image_problem(image_)) fail(path_, event, *problem);
    FrameSummary& summary = contents_.summary;
    const cv::Size size(image_.width, image_.height);
    if (summary.frames == 0) {
      summary.size = size;
      first_timestamp_ns_ = image_.timestamp_ns;
    } else if (size != summary.size) {
      fail(path_, event,
           fmt::format("the image is {}x{}, those before are {}x{}", size.width, size.height,
                       summary.size.width, summary.size.height));
    } else if (image_.timestamp_ns <= last_timestamp_ns_) {
      fail(path_, event, "the image's time stamp is not after the one before");
    }
    last_timestamp_ns_ = image_.timestamp_ns;
    ++summary.frames;
  }

  void take_datagram(const LcmLogEvent& event) {
    const std::optional<datagram_t> datagram = decode_datagram(event.data);
    if (!datagram) fail(path_, event, "not a datagram_t");
    if (datagram->size > kMaxDatagramBytes) fail(path_, event, "longer than any UDP datagram");
    std::vector<RecordedDatagram>& datagrams = contents_.datagrams;
    if (!datagrams.empty() && datagram->arrival_ns < datagrams.back().arrival_ns) {
      fail(path_, event, "the datagram arrived before the one before");
    }
    datagrams.push_back(
        {datagram->arrival_ns, std::string(datagram->data.begin(), datagram->data.end())});
  }

  const std::filesystem::path& path_;
  LogContents contents_;
  std::string datagram_channel_;
  CheckedImage image_;
  std::int64_t first_timestamp_ns_{0};
  std::int64_t last_timestamp_ns_{0};
};

}  // namespace

LogContents scan_log(const std::filesystem::path& path) {
  LcmLogReader log(path);
  LcmLogEvent event;
  Scan scan(path);
  while (log.next(event)) scan.take(event);
  return scan.finish();
}

}  // namespace handeye
