// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <linux/videodev2.h>
#include <vector>

#include "drivers/v4l2/v4l2_device.hpp"
#include "drivers/v4l2/v4l2_modes.hpp"

namespace handeye {

/// Every mode that the device says it has in a format we know. Of a range of sizes only the wished
/// one is listed, if it lies within.
std::vector<V4l2Mode> enumerate_modes(const V4l2Device& device, const V4l2Wish& wish);

/// The rate [Hz] of an interval [s]; 0 when it is none.
double rate_of(const v4l2_fract& interval_s);

}  // namespace handeye
