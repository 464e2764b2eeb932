// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/lcm_log_reader.hpp"

#include <array>

#include <fmt/format.h>

#include "drivers/recording/file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01U;
constexpr std::int64_t kHeaderBytes = 4 + 8 + 8 + 4 + 4;
constexpr std::int64_t kMaxChannelBytes = 63;  // LCM's own limit

template <typename Integer>
Integer read_big_endian(const std::uint8_t* bytes) {
  std::make_unsigned_t<Integer> value = 0;
  for (std::size_t i = 0; i < sizeof(Integer); ++i) {
    value = static_cast<std::make_unsigned_t<Integer>>(value << 8 | bytes[i]);
  }
  return static_cast<Integer>(value);
}

}  // namespace

LcmLogReader::LcmLogReader(std::filesystem::path path)
    : path_(std::move(path)), file_(open_for_reading(path_)) {
  file_.seekg(0, std::ios::end);
  file_bytes_ = file_.tellg();
  rewind();
}

void LcmLogReader::rewind() {
  file_.clear();
  file_.seekg(0);
  position_ = 0;
  events_read_ = 0;
}

bool LcmLogReader::next(LcmLogEvent& event) {
  if (position_ == file_bytes_) return false;
  event.number = events_read_;
  event.offset_bytes = position_;

  std::array<std::uint8_t, static_cast<std::size_t>(kHeaderBytes)> header{};
  read(header.data(), kHeaderBytes);
  event.timestamp_us = read_big_endian<std::int64_t>(&header[12]);
  const std::int64_t channel_bytes = read_big_endian<std::int32_t>(&header[20]);
  const std::int64_t data_bytes = read_big_endian<std::int32_t>(&header[24]);
  if (read_big_endian<std::uint32_t>(&header[0]) != kSyncWord || channel_bytes < 1 ||
      channel_bytes > kMaxChannelBytes || data_bytes < 0) {
    throw InputError(fmt::format("{}: {} at byte {}; use an undamaged LCM log (.lcm)",
                                 path_.string(),
                                 events_read_ == 0 ? "no LCM log, the first event is missing"
                                                   : "damaged, no LCM event where one must begin",
                                 event.offset_bytes));
  }
  event.channel.resize(static_cast<std::size_t>(channel_bytes));
  read(event.channel.data(), channel_bytes);
  // Before anything is reserved for them: the bytes must be there.
  if (file_bytes_ - position_ >= data_bytes)
    event.data.resize(static_cast<std::size_t>(data_bytes));
  read(event.data.data(), data_bytes);
  ++events_read_;
  return true;
}

void LcmLogReader::read(void* target, std::int64_t bytes) {
  if (file_bytes_ - position_ < bytes ||
      !file_.read(static_cast<char*>(target), static_cast<std::streamsize>(bytes))) {
    throw InputError(fmt::format(
        "{}: cut short, event {} is incomplete at byte {}; copy the file again or record "
        "anew",
        path_.string(), events_read_, position_));
  }
  position_ += bytes;
}

}  // namespace handeye
