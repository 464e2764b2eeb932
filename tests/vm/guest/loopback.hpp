// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace handeye {

/// A video device of the kernel module v4l2loopback, and who writes to it. In a guest only: loads
/// the module, and unloads it at the end.
class Loopback {
 public:
  static constexpr const char* kDevice = "/dev/video9";

  /// Shows pictures of this kind; throws std::runtime_error where it does not.
  Loopback(std::uint32_t fourcc, int width, int height);
  ~Loopback();
  Loopback(const Loopback&) = delete;
  Loopback& operator=(const Loopback&) = delete;

  /// As one picture, whatever it is.
  void write(const std::vector<std::uint8_t>& bytes) const;

 private:
  int descriptor_{-1};
};

}  // namespace handeye
