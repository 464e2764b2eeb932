// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_device.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace handeye {

std::optional<std::string> V4l2Device::open(const std::string& path) {
  close();
  path_ = path;
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return errno == EACCES ? failure("open", EACCES) : path + ": not there";
  }
  if (!S_ISCHR(status.st_mode)) return path + ": not a capture device";
  descriptor_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) return failure("open", errno);
  auto problem = check_capabilities();
  if (problem) close();
  return problem;
}

void V4l2Device::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

std::optional<std::string> V4l2Device::check_capabilities() {
  v4l2_capability capability{};
  if (request(VIDIOC_QUERYCAP, &capability) != 0) return path_ + ": not a capture device";
  // A driver may have several nodes: device_caps is this node's, capabilities that of all together.
  const bool tells_node = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t node = tells_node ? capability.device_caps : capability.capabilities;
  const bool singleplanar = (node & V4L2_CAP_VIDEO_CAPTURE) != 0;
  multiplanar_ = !singleplanar && (node & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
  if (!singleplanar && !multiplanar_) return path_ + ": not a capture device";
  if ((node & V4L2_CAP_STREAMING) == 0) return path_ + ": cannot stream";
  return std::nullopt;
}

int V4l2Device::request(unsigned long code, void* argument) const {
  for (;;) {
    if (ioctl(descriptor_, code, argument) >= 0) return 0;
    if (errno != EINTR) return errno;
  }
}

std::string V4l2Device::failure(const std::string& doing, int error) const {
  switch (error) {
    case EACCES:
      return path_ + ": permission denied; add the user to the group video";
    case EPERM:  // systemd's DevicePolicy says so, not the file's rights
      return path_ + ": forbidden by the service's unit; see DeviceAllow there";
    case EBUSY:
      return path_ + ": in use by another program";
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return path_ + ": not there";
    default:
      return path_ + ": cannot " + doing + ": " + std::strerror(error);
  }
}

}  // namespace handeye
