// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <sys/time.h>

namespace handeye {

/// When a buffer's image was taken, mid-exposure on CLOCK_MONOTONIC [ns].
///
/// `flags` and `stamp` are the buffer's, `arrival_ns` is when we took it from the driver,
/// `half_exposure_ns` half the exposure time (0: not known).
/// The driver's stamp is used when it is on the monotonic clock, or does not say which clock and
/// fits (v4l2loopback), and lies within plausible distance of the arrival; else the arrival. A
/// stamp of the start of exposure is moved later by half the exposure; one of the end, or an
/// arrival, earlier.
std::int64_t mid_exposure_ns(std::uint32_t flags, const timeval& stamp, std::int64_t arrival_ns,
                             std::int64_t half_exposure_ns);

}  // namespace handeye
