// SPDX-License-Identifier: BSD-3-Clause
#include "tests/vm/guest/vivid.hpp"

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

void run(const char* command) {
  if (std::system(command) != 0) throw std::runtime_error(fmt::format("failed: {}", command));
}

/// A device that is open as long as this lives.
class Descriptor {
 public:
  explicit Descriptor(const char* device) : value_(open(device, O_RDWR | O_CLOEXEC)) {
    if (value_ < 0) throw std::runtime_error(fmt::format("{}: {}", device, std::strerror(errno)));
  }
  ~Descriptor() { close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  template <typename Argument>
  void request(unsigned long code, Argument* argument) {
    if (ioctl(value_, code, argument) == 0) return;
    throw std::runtime_error(fmt::format("request {:#x}: {}", code, std::strerror(errno)));
  }

  template <typename Argument>
  bool try_request(unsigned long code, Argument* argument) {
    return ioctl(value_, code, argument) == 0;
  }

 private:
  int value_;
};

std::uint32_t control_id(Descriptor& device, const std::string& name) {
  v4l2_queryctrl query{};
  query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (device.try_request(VIDIOC_QUERYCTRL, &query)) {
    if (name == reinterpret_cast<const char*>(query.name)) return query.id;
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  throw std::runtime_error(fmt::format("vivid has no control '{}'", name));
}

}  // namespace

void load_vivid() {
  // Capture nodes only; two bits an input: webcam 0, television 1, HDMI 3.
  run("modprobe vivid n_devs=2 node_types=0x1,0x1 multiplanar=1,2 vid_cap_nr=0,1 "
      "num_inputs=3,1 input_types=0x1c,0x0");
  // The clock and counters in the picture are not wanted, and every test sets what it needs.
  for (const char* const device : {kVivid, kVividMultiplanar}) {
    set_menu("OSD Text Mode", "None", device);
    set_menu("Timestamp Source", "Start of Exposure", device);
  }
}

void unload_vivid() {
  run("modprobe -r vivid");
}

void set_control(const std::string& name, std::int32_t value, const char* device) {
  Descriptor descriptor(device);
  v4l2_control control{control_id(descriptor, name), value};
  descriptor.request(VIDIOC_S_CTRL, &control);
}

void set_menu(const std::string& name, const std::string& item, const char* device) {
  const auto find = [&]() -> std::int32_t {
    Descriptor descriptor(device);
    v4l2_querymenu menu{};
    menu.id = control_id(descriptor, name);
    constexpr std::uint32_t kLongest = 256;
    for (menu.index = 0; menu.index < kLongest; ++menu.index) {
      if (!descriptor.try_request(VIDIOC_QUERYMENU, &menu)) continue;  // menus may have gaps
      if (item == reinterpret_cast<const char*>(menu.name)) return static_cast<int>(menu.index);
    }
    throw std::runtime_error(fmt::format("vivid's '{}' has no '{}'", name, item));
  };
  set_control(name, find(), device);
}

void select_input(VividInput input) {
  Descriptor descriptor(kVivid);
  int number = static_cast<int>(input);
  descriptor.request(VIDIOC_S_INPUT, &number);
}

std::string driver_name(const char* device) {
  Descriptor descriptor(device);
  v4l2_capability capability{};
  descriptor.request(VIDIOC_QUERYCAP, &capability);
  return reinterpret_cast<const char*>(capability.driver);
}

VividSetting setting_of(const char* device) {
  Descriptor descriptor(device);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  descriptor.request(VIDIOC_G_FMT, &format);
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  descriptor.request(VIDIOC_G_PARM, &parameters);
  const v4l2_fract& period_s = parameters.parm.capture.timeperframe;
  return {format.fmt.pix.pixelformat, static_cast<int>(format.fmt.pix.width),
          static_cast<int>(format.fmt.pix.height),
          static_cast<double>(period_s.denominator) / period_s.numerator};
}

}  // namespace handeye
