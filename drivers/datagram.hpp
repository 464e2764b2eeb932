// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace handeye {

/// One raw datagram of the tracker. The bytes belong to whoever hands it out.
struct Datagram {
  std::int64_t arrival_ns{0};  ///< when the kernel received it, host CLOCK_MONOTONIC
  std::string_view bytes;      ///< untouched, 0..65507 bytes
};

}  // namespace handeye
