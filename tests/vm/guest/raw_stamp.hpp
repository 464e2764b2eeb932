// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye {

/// What the kernel said about the buffer taken last, seen on its way to our driver: the linker
/// sends the driver's ioctl through here (option --wrap=ioctl), and on to the kernel.
struct RawStamp {
  std::int64_t stamp_ns{0};
  std::uint32_t sequence{0};
  std::uint32_t flags{0};
};

const RawStamp& raw_stamp();

}  // namespace handeye
