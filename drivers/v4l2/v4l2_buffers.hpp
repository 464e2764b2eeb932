// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <sys/time.h>
#include <vector>

#include "drivers/v4l2/v4l2_device.hpp"

namespace handeye {

/// One filled buffer. The bytes are the driver's memory, until the buffer is queued again.
struct V4l2Filled {
  std::uint32_t index{0};
  std::uint32_t flags{0};
  std::uint32_t sequence{0};
  timeval timestamp{};
  std::span<const std::uint8_t> bytes;
};

/// The buffers that a device fills, mapped into this process. Of a format with several planes only
/// the first is mapped: it holds the luminance.
class V4l2Buffers {
 public:
  V4l2Buffers() = default;
  ~V4l2Buffers() { release(); }
  V4l2Buffers(const V4l2Buffers&) = delete;
  V4l2Buffers& operator=(const V4l2Buffers&) = delete;

  /// Asks for buffers, maps and queues them and starts the stream. Nothing on success.
  std::optional<std::string> start(const V4l2Device& device);

  /// Takes a filled buffer. 0, or the error number (EAGAIN: none is ready).
  int take(const V4l2Device& device, V4l2Filled& filled);

  /// Gives a buffer back to be filled. 0, or the error number.
  int give_back(const V4l2Device& device, std::uint32_t index);

  /// Unmaps everything. The device may be gone already.
  void release();

 private:
  struct Mapping {
    void* memory;
    std::size_t length;
  };

  std::optional<std::string> map(const V4l2Device& device, std::uint32_t index);

  std::vector<Mapping> mappings_;
  std::uint32_t planes_{1};
};

}  // namespace handeye
