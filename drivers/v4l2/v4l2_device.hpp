// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <linux/videodev2.h>
#include <optional>
#include <string>

namespace handeye {

/// An open video device that captures and streams; owns the descriptor.
class V4l2Device {
 public:
  V4l2Device() = default;
  ~V4l2Device() { close(); }
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;

  /// Nothing on success; else why not, in one line: "/dev/video0: not there".
  std::optional<std::string> open(const std::string& path);
  void close();
  bool is_open() const { return descriptor_ >= 0; }

  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }

  /// The buffer type that goes with this device in every request.
  v4l2_buf_type buffer_type() const {
    return multiplanar_ ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  }
  bool multiplanar() const { return multiplanar_; }

  /// One ioctl, again when a signal interrupts it. 0, or the error number.
  int request(unsigned long code, void* argument) const;

  /// One line for a failed request: "/dev/video0: in use by another program".
  std::string failure(const std::string& doing, int error) const;

 private:
  std::optional<std::string> check_capabilities();

  std::string path_;
  int descriptor_{-1};
  bool multiplanar_{false};
};

}  // namespace handeye
