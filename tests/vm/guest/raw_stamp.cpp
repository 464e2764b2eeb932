// SPDX-License-Identifier: BSD-3-Clause
#include "tests/vm/guest/raw_stamp.hpp"

#include <cstdarg>
#include <linux/videodev2.h>

namespace handeye {
namespace {

RawStamp last;

}  // namespace

const RawStamp& raw_stamp() {
  return last;
}

}  // namespace handeye

extern "C" {
int __real_ioctl(int descriptor, unsigned long code, ...);

int __wrap_ioctl(int descriptor, unsigned long code, ...) {
  va_list arguments;
  va_start(arguments, code);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  const int result = __real_ioctl(descriptor, code, argument);
  if (result == 0 && code == VIDIOC_DQBUF) {
    const v4l2_buffer& buffer = *static_cast<const v4l2_buffer*>(argument);
    const timeval& stamp = buffer.timestamp;
    handeye::last = {stamp.tv_sec * 1'000'000'000LL + stamp.tv_usec * 1'000LL, buffer.sequence,
                     buffer.flags};
  }
  return result;
}
}
