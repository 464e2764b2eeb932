// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_enumeration.hpp"

#include <algorithm>

namespace handeye {
namespace {

/// The highest rate of one format and size; 0 when the device does not tell.
double max_rate_hz(const V4l2Device& device, const V4l2Mode& mode) {
  double highest = 0;
  v4l2_frmivalenum interval{};
  interval.pixel_format = mode.fourcc;
  interval.width = static_cast<std::uint32_t>(mode.width);
  interval.height = static_cast<std::uint32_t>(mode.height);
  for (; device.request(VIDIOC_ENUM_FRAMEINTERVALS, &interval) == 0; ++interval.index) {
    if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE) return rate_of(interval.stepwise.min);
    highest = std::max(highest, rate_of(interval.discrete));
  }
  return highest;
}

bool contains(const v4l2_frmsize_stepwise& range, const V4l2Wish& wish) {
  const auto fits = [](int wanted, std::uint32_t min, std::uint32_t max, std::uint32_t step) {
    const auto side = static_cast<std::uint32_t>(wanted);
    return side >= min && side <= max && (step == 0 || (side - min) % step == 0);
  };
  return fits(wish.width, range.min_width, range.max_width, range.step_width) &&
         fits(wish.height, range.min_height, range.max_height, range.step_height);
}

/// The sizes of one format; of a continuous range only the wished one.
void add_modes(const V4l2Device& device, std::uint32_t fourcc, const V4l2Wish& wish,
               std::vector<V4l2Mode>& modes) {
  const auto add = [&](int width, int height) {
    V4l2Mode mode{fourcc, width, height, 0};
    mode.max_rate_hz = max_rate_hz(device, mode);
    modes.push_back(mode);
  };
  v4l2_frmsizeenum size{};
  size.pixel_format = fourcc;
  for (; device.request(VIDIOC_ENUM_FRAMESIZES, &size) == 0; ++size.index) {
    if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
      if (contains(size.stepwise, wish)) add(wish.width, wish.height);
      return;
    }
    add(static_cast<int>(size.discrete.width), static_cast<int>(size.discrete.height));
  }
  const bool tells_no_sizes = size.index == 0;
  if (tells_no_sizes) modes.push_back({fourcc, 0, 0, 0});
}

}  // namespace

double rate_of(const v4l2_fract& interval_s) {
  if (interval_s.numerator == 0) return 0;
  return static_cast<double>(interval_s.denominator) / interval_s.numerator;
}

std::vector<V4l2Mode> enumerate_modes(const V4l2Device& device, const V4l2Wish& wish) {
  std::vector<V4l2Mode> modes;
  v4l2_fmtdesc description{};
  description.type = device.buffer_type();
  for (; device.request(VIDIOC_ENUM_FMT, &description) == 0; ++description.index) {
    if (pixel_format_of(description.pixelformat)) {
      add_modes(device, description.pixelformat, wish, modes);
    }
  }
  return modes;
}

}  // namespace handeye
