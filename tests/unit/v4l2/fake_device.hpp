// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <linux/videodev2.h>
#include <vector>

namespace handeye {

/// A frame that the fake device will deliver.
struct FakeFrame {
  std::uint32_t sequence{0};
  std::uint32_t flags{V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE};
  std::int64_t stamp_ns{0};  ///< 0: now
  std::vector<std::uint8_t> bytes;
};

/// A V4L2 device in this process. While one exists, ioctl, poll, mmap and munmap on kFakePath go to
/// it. It checks that buffers are used as the kernel demands: queued once, taken only when filled.
class FakeDevice {
 public:
  FakeDevice();
  ~FakeDevice();
  FakeDevice(const FakeDevice&) = delete;
  FakeDevice& operator=(const FakeDevice&) = delete;

  // What the device is.
  std::uint32_t device_caps{V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING};
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_YUYV};
  std::uint32_t width{16}, height{8};
  std::uint32_t padding_bytes{0};
  std::uint32_t field{V4L2_FIELD_NONE};
  std::uint32_t rate_hz{25};

  // What happens.
  std::deque<FakeFrame> frames;      ///< delivered in this order
  unsigned long failing_request{0};  ///< this ioctl ...
  int failing_error{0};              ///< ... fails with this error
  short poll_events{0};              ///< reported by poll beside POLLIN
  std::deque<std::uint32_t> events;  ///< types of events that wait
  bool signal_unsettled{false};      ///< it changes as soon as its timings have been read

  // What the driver did.
  std::size_t mapped() const { return mapped_; }
  bool streaming() const { return streaming_; }
  std::uint32_t fourcc() const { return fourcc_; }

  int request(unsigned long code, void* argument);
  int poll_once(short wanted, short& returned) const;
  void* map(std::size_t length, std::int64_t offset);
  bool unmap(void* memory);
  void reset_stream();

 private:
  static constexpr std::size_t kBuffers = 4;
  static constexpr std::size_t kBufferBytes = 4096;

  bool multiplanar() const { return (device_caps & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0; }
  int get_format(v4l2_format& format) const;
  int set_format(v4l2_format& format);
  int query_buffer(v4l2_buffer& buffer) const;
  int queue(const v4l2_buffer& buffer);
  int dequeue(v4l2_buffer& buffer);
  std::uint32_t stride_bytes() const;

  std::uint32_t fourcc_{0};
  bool streaming_{false};
  bool subscribed_{false};
  std::size_t mapped_{0};
  std::deque<std::uint32_t> queued_;
  std::array<std::array<std::uint8_t, kBufferBytes>, kBuffers> memory_{};
};

/// The path that leads to the fake; a character device that always exists.
inline constexpr const char* kFakePath = "/dev/zero";

}  // namespace handeye
