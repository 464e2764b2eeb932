// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/v4l2/fake_device.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <poll.h>
#include <sys/mman.h>

#include "protocol/bus.hpp"

namespace handeye {
namespace {

FakeDevice* current = nullptr;

template <typename Argument>
Argument& as(void* argument) {
  return *static_cast<Argument*>(argument);
}

}  // namespace

FakeDevice::FakeDevice() {
  current = this;
}

FakeDevice::~FakeDevice() {
  current = nullptr;
}

int FakeDevice::request(unsigned long code, void* argument) {
  if (code == failing_request) return failing_error;
  switch (code) {
    case VIDIOC_QUERYCAP:
      as<v4l2_capability>(argument).capabilities = V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE;
      as<v4l2_capability>(argument).device_caps = device_caps;
      return 0;
    case VIDIOC_ENUM_FMT: {
      auto& description = as<v4l2_fmtdesc>(argument);
      if (description.index >= formats.size()) return EINVAL;
      description.pixelformat = formats[description.index];
      return 0;
    }
    case VIDIOC_ENUM_FRAMESIZES: {
      auto& size = as<v4l2_frmsizeenum>(argument);
      if (size.index > 0) return EINVAL;
      size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      size.discrete = {width, height};
      return 0;
    }
    case VIDIOC_ENUM_FRAMEINTERVALS: {
      auto& interval = as<v4l2_frmivalenum>(argument);
      if (interval.index > 0) return EINVAL;
      interval.type = V4L2_FRMIVAL_TYPE_DISCRETE;
      interval.discrete = {1, rate_hz};
      return 0;
    }
    case VIDIOC_G_FMT:
      return get_format(as<v4l2_format>(argument));
    case VIDIOC_S_FMT:
      return set_format(as<v4l2_format>(argument));
    case VIDIOC_G_PARM:
      as<v4l2_streamparm>(argument).parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
      as<v4l2_streamparm>(argument).parm.capture.timeperframe = {1, rate_hz};
      return 0;
    case VIDIOC_S_PARM:
      return 0;
    case VIDIOC_REQBUFS:
      as<v4l2_requestbuffers>(argument).count = kBuffers;
      return 0;
    case VIDIOC_QUERYBUF:
      return query_buffer(as<v4l2_buffer>(argument));
    case VIDIOC_QBUF:
      return queue(as<v4l2_buffer>(argument));
    case VIDIOC_DQBUF:
      return dequeue(as<v4l2_buffer>(argument));
    case VIDIOC_STREAMON:
      streaming_ = true;
      return 0;
    case VIDIOC_G_INPUT:
      return 0;
    case VIDIOC_SUBSCRIBE_EVENT:
      subscribed_ = true;
      return 0;
    case VIDIOC_QUERY_DV_TIMINGS:
      if (!signal_unsettled) return ENOTTY;
      if (subscribed_) events.push_back(V4L2_EVENT_SOURCE_CHANGE);
      return 0;
    case VIDIOC_S_DV_TIMINGS:
      return signal_unsettled ? 0 : ENOTTY;
    case VIDIOC_DQEVENT:
      if (events.empty()) return ENOENT;
      as<v4l2_event>(argument).type = events.front();
      events.pop_front();
      return 0;
    default:
      return ENOTTY;
  }
}

std::uint32_t FakeDevice::stride_bytes() const {
  const bool packed = fourcc_ == V4L2_PIX_FMT_YUYV || fourcc_ == V4L2_PIX_FMT_UYVY;
  return width * (packed ? 2 : 1) + padding_bytes;
}

int FakeDevice::get_format(v4l2_format& format) const {
  if (multiplanar()) {
    v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    pix.pixelformat = fourcc_;
    pix.width = width;
    pix.height = height;
    pix.field = static_cast<std::uint8_t>(field);
    pix.num_planes = 2;
    pix.plane_fmt[0].bytesperline = stride_bytes();
  } else {
    v4l2_pix_format& pix = format.fmt.pix;
    pix.pixelformat = fourcc_;
    pix.width = width;
    pix.height = height;
    pix.field = field;
    pix.bytesperline = stride_bytes();
  }
  return 0;
}

int FakeDevice::set_format(v4l2_format& format) {
  fourcc_ = multiplanar() ? format.fmt.pix_mp.pixelformat : format.fmt.pix.pixelformat;
  return get_format(format);
}

int FakeDevice::query_buffer(v4l2_buffer& buffer) const {
  if (buffer.index >= kBuffers) return EINVAL;
  const auto offset = static_cast<std::uint32_t>(buffer.index * kBufferBytes);
  if (multiplanar()) {
    if (buffer.length < 2) return EINVAL;
    buffer.length = 2;
    buffer.m.planes[0].length = kBufferBytes;
    buffer.m.planes[0].m.mem_offset = offset;
  } else {
    buffer.length = kBufferBytes;
    buffer.m.offset = offset;
  }
  return 0;
}

int FakeDevice::queue(const v4l2_buffer& buffer) {
  const bool twice = std::find(queued_.begin(), queued_.end(), buffer.index) != queued_.end();
  if (buffer.index >= kBuffers || twice || (multiplanar() && buffer.length < 2)) return EINVAL;
  queued_.push_back(buffer.index);
  return 0;
}

int FakeDevice::dequeue(v4l2_buffer& buffer) {
  if (!streaming_) return EINVAL;
  if (frames.empty() || queued_.empty()) return EAGAIN;
  const FakeFrame frame = frames.front();
  frames.pop_front();
  buffer.index = queued_.front();
  queued_.pop_front();
  std::copy(frame.bytes.begin(), frame.bytes.end(), memory_[buffer.index].begin());
  const auto used = static_cast<std::uint32_t>(frame.bytes.size());
  if (multiplanar()) {
    if (buffer.length < 2) return EINVAL;
    buffer.m.planes[0].bytesused = used;
    buffer.m.planes[0].data_offset = 0;
  } else {
    buffer.bytesused = used;
  }
  buffer.flags = frame.flags;
  buffer.sequence = frame.sequence;
  const std::int64_t stamp_ns = frame.stamp_ns == 0 ? monotonic_ns() : frame.stamp_ns;
  buffer.timestamp = {stamp_ns / 1'000'000'000, stamp_ns % 1'000'000'000 / 1000};
  return 0;
}

int FakeDevice::poll_once(short wanted, short& returned) const {
  returned = poll_events;
  if (streaming_ && !frames.empty()) returned = static_cast<short>(returned | (wanted & POLLIN));
  if (!events.empty()) returned = static_cast<short>(returned | (wanted & POLLPRI));
  return returned == 0 ? 0 : 1;
}

void* FakeDevice::map(std::size_t length, std::int64_t offset) {
  if (length != kBufferBytes) return MAP_FAILED;
  ++mapped_;
  return memory_.at(static_cast<std::size_t>(offset) / kBufferBytes).data();
}

bool FakeDevice::unmap(void* memory) {
  const auto is_ours = [&](const auto& buffer) { return buffer.data() == memory; };
  if (std::none_of(memory_.begin(), memory_.end(), is_ours)) return false;
  --mapped_;
  return true;
}

void FakeDevice::reset_stream() {
  streaming_ = false;
  queued_.clear();
}

}  // namespace handeye

// The linker replaces the calls of the names without __wrap_ by these (option --wrap).
extern "C" {
int __real_ioctl(int descriptor, unsigned long code, ...);
int __real_poll(pollfd* descriptors, nfds_t count, int timeout_ms);
void* __real_mmap(void* wanted, std::size_t length, int protection, int flags, int descriptor,
                  off_t offset);
int __real_munmap(void* memory, std::size_t length);

int __wrap_ioctl(int descriptor, unsigned long code, ...) {
  va_list arguments;
  va_start(arguments, code);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  if (handeye::current == nullptr) return __real_ioctl(descriptor, code, argument);
  const int error = handeye::current->request(code, argument);
  errno = error;
  return error == 0 ? 0 : -1;
}

int __wrap_poll(pollfd* descriptors, nfds_t count, int timeout_ms) {
  if (handeye::current == nullptr) return __real_poll(descriptors, count, timeout_ms);
  const int ready = handeye::current->poll_once(descriptors[0].events, descriptors[0].revents);
  return ready != 0 ? ready : __real_poll(nullptr, 0, timeout_ms);
}

void* __wrap_mmap(void* wanted, std::size_t length, int protection, int flags, int descriptor,
                  off_t offset) {
  if (handeye::current == nullptr || descriptor < 0) {
    return __real_mmap(wanted, length, protection, flags, descriptor, offset);
  }
  return handeye::current->map(length, offset);
}

int __wrap_munmap(void* memory, std::size_t length) {
  if (handeye::current != nullptr && handeye::current->unmap(memory)) return 0;
  return __real_munmap(memory, length);
}
}
