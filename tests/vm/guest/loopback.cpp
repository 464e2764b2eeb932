// SPDX-License-Identifier: BSD-3-Clause
#include "tests/vm/guest/loopback.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace handeye {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(
      fmt::format("{}: {}: {}", Loopback::kDevice, what, std::strerror(errno)));
}

}  // namespace

Loopback::Loopback(std::uint32_t fourcc, int width, int height) {
  if (std::system("modprobe v4l2loopback video_nr=9 exclusive_caps=0") != 0) {
    throw std::runtime_error("modprobe v4l2loopback failed");
  }
  descriptor_ = open(kDevice, O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) fail("open");
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = static_cast<std::uint32_t>(width);
  format.fmt.pix.height = static_cast<std::uint32_t>(height);
  format.fmt.pix.pixelformat = fourcc;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.sizeimage = static_cast<std::uint32_t>(2 * width * height);
  if (ioctl(descriptor_, VIDIOC_S_FMT, &format) != 0) fail("VIDIOC_S_FMT");
  if (format.fmt.pix.pixelformat != fourcc) fail("another format");
}

Loopback::~Loopback() {
  close(descriptor_);
  if (std::system("modprobe -r v4l2loopback") != 0) std::abort();
}

void Loopback::write(const std::vector<std::uint8_t>& bytes) const {
  if (::write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
    fail("write");
  }
}

}  // namespace handeye
