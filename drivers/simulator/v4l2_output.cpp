// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/v4l2_output.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {

V4l2Output::V4l2Output(const std::string& path, int width, int height)
    : path_(path), descriptor_(open(path.c_str(), O_RDWR | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    throw InputError(fmt::format("{}: {}; make such a device with the kernel module v4l2loopback",
                                 path, std::strerror(errno)));
  }
  try {
    choose_format(width, height);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

V4l2Output::~V4l2Output() {
  close(descriptor_);
}

void V4l2Output::choose_format(int width, int height) const {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = static_cast<std::uint32_t>(width);
  format.fmt.pix.height = static_cast<std::uint32_t>(height);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_GREY;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const v4l2_format wanted = format;
  if (ioctl(descriptor_, VIDIOC_S_FMT, &format) != 0) {
    throw InputError(
        fmt::format("{}: no video device that pictures can be written to ({}); name "
                    "one of v4l2loopback's",
                    path_, std::strerror(errno)));
  }
  // A device may answer with what it has instead.
  if (format.fmt.pix.width != wanted.fmt.pix.width ||
      format.fmt.pix.height != wanted.fmt.pix.height ||
      format.fmt.pix.pixelformat != wanted.fmt.pix.pixelformat) {
    throw InputError(
        fmt::format("{}: does not take grey pictures of {}x{}; choose another --width "
                    "and --height",
                    path_, width, height));
  }
}

bool V4l2Output::show(const cv::Mat& grey) const {
  const std::size_t size = grey.total();
  return write(descriptor_, grey.data, size) == static_cast<ssize_t>(size);
}

}  // namespace handeye::simulator
