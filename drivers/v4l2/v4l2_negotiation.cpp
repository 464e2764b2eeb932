// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_negotiation.hpp"

#include <cerrno>

#include <fmt/format.h>

#include "drivers/v4l2/v4l2_enumeration.hpp"

namespace handeye {
namespace {

/// Takes over the timings of an HDMI or SDI signal; devices of other kinds have none.
std::optional<std::string> adopt_signal(const V4l2Device& device) {
  v4l2_dv_timings timings{};
  switch (const int error = device.request(VIDIOC_QUERY_DV_TIMINGS, &timings)) {
    case 0:
      break;
    case ENOLINK:
      return device.path() + ": no signal; is the cable in and the camera on?";
    case ENOLCK:
      return device.path() + ": unstable signal; check the cable";
    case ERANGE:
      return device.path() + ": signal out of range; set the camera to another video mode";
    case EBUSY:
      return device.failure("read the signal", error);
    default:
      return std::nullopt;
  }
  const int error = device.request(VIDIOC_S_DV_TIMINGS, &timings);
  if (error != 0) return device.failure("adopt the signal", error);
  return std::nullopt;
}

/// The event's id is the number of the input; with another nothing would arrive.
void subscribe_to_signal_changes(const V4l2Device& device) {
  int input = 0;
  if (device.request(VIDIOC_G_INPUT, &input) != 0) input = 0;
  v4l2_event_subscription subscription{};
  subscription.type = V4L2_EVENT_SOURCE_CHANGE;
  subscription.id = static_cast<std::uint32_t>(input);
  // Cameras without a changing signal refuse; nothing is lost by it.
  device.request(VIDIOC_SUBSCRIBE_EVENT, &subscription);
}

std::string format_names(const V4l2Wish& wish) {
  std::string names;
  for (const PixelFormat format : wish.formats) {
    names += names.empty() ? name_of(format) : std::string(", ") + name_of(format);
  }
  return names;
}

/// The members of v4l2_format that we use, of either kind of device.
struct FormatFields {
  std::uint32_t fourcc, width, height, field, stride_bytes;
};

FormatFields fields_of(const V4l2Device& device, const v4l2_format& format) {
  if (device.multiplanar()) {
    const v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    return {pix.pixelformat, pix.width, pix.height, pix.field, pix.plane_fmt[0].bytesperline};
  }
  const v4l2_pix_format& pix = format.fmt.pix;
  return {pix.pixelformat, pix.width, pix.height, pix.field, pix.bytesperline};
}

void put_mode(const V4l2Device& device, const V4l2Mode& mode, v4l2_format& format) {
  const auto width = static_cast<std::uint32_t>(mode.width);
  const auto height = static_cast<std::uint32_t>(mode.height);
  if (device.multiplanar()) {
    v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    pix = {};
    pix.pixelformat = mode.fourcc;
    pix.width = width;
    pix.height = height;
    pix.field = V4L2_FIELD_NONE;
  } else {
    v4l2_pix_format& pix = format.fmt.pix;
    pix = {};
    pix.pixelformat = mode.fourcc;
    pix.width = width;
    pix.height = height;
    pix.field = V4L2_FIELD_NONE;
  }
}

/// Sets the mode and reads back what the device made of it.
std::variant<V4l2Stream, std::string> set_mode(const V4l2Device& device, const V4l2Mode& mode) {
  v4l2_format format{};
  format.type = device.buffer_type();
  put_mode(device, mode, format);
  if (const int error = device.request(VIDIOC_S_FMT, &format); error != 0) {
    return device.failure("set the format", error);
  }
  const FormatFields fields = fields_of(device, format);
  const auto width = static_cast<int>(fields.width);
  const auto height = static_cast<int>(fields.height);
  if (fields.fourcc != mode.fourcc || width != mode.width || height != mode.height) {
    return fmt::format("{}: delivers {}x{} {} when asked for {}x{} {}; configure what it can",
                       device.path(), width, height, fourcc_text(fields.fourcc), mode.width,
                       mode.height, fourcc_text(mode.fourcc));
  }
  if (fields.field != V4L2_FIELD_NONE && fields.field != V4L2_FIELD_INTERLACED) {
    return device.path() + ": delivers half images (fields); set the camera to a progressive mode";
  }
  V4l2Stream stream;
  stream.format = pixel_format_of(fields.fourcc).value();
  stream.fourcc = fields.fourcc;
  stream.width = width;
  stream.height = height;
  stream.stride_bytes =
      stream.format == PixelFormat::kJpeg ? 0 : static_cast<int>(fields.stride_bytes);
  stream.interlaced = fields.field == V4L2_FIELD_INTERLACED;
  return stream;
}

/// Sets the rate if one is wished; the rate the device then says it has.
double set_rate(const V4l2Device& device, double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = device.buffer_type();
  if (device.request(VIDIOC_G_PARM, &parameters) != 0) return 0;
  v4l2_captureparm& capture = parameters.parm.capture;
  if (rate_hz > 0 && (capture.capability & V4L2_CAP_TIMEPERFRAME) != 0) {
    constexpr std::uint32_t kMillihertz = 1000;
    capture.timeperframe = {kMillihertz, static_cast<std::uint32_t>(rate_hz * kMillihertz + 0.5)};
    if (device.request(VIDIOC_S_PARM, &parameters) != 0) return 0;
  }
  return rate_of(capture.timeperframe);
}

}  // namespace

std::variant<V4l2Stream, std::string> negotiate(const V4l2Device& device, const V4l2Wish& wish) {
  if (const auto problem = adopt_signal(device)) return *problem;
  subscribe_to_signal_changes(device);
  // Again, for a change before the subscription was missed. Not the subscription first: some
  // drivers report it as a change when we take over what has changed.
  if (const auto problem = adopt_signal(device)) return *problem;

  V4l2Wish wanted = wish;
  if (wanted.width == 0 || wanted.height == 0) {
    v4l2_format current{};
    current.type = device.buffer_type();
    if (const int error = device.request(VIDIOC_G_FMT, &current); error != 0) {
      return device.failure("read the format", error);
    }
    const FormatFields fields = fields_of(device, current);
    wanted.width = static_cast<int>(fields.width);
    wanted.height = static_cast<int>(fields.height);
  }

  std::optional<V4l2Mode> mode = choose_mode(enumerate_modes(device, wanted), wanted);
  if (!mode) {
    return fmt::format("{}: offers no {}x{} in {}; configure a size it offers", device.path(),
                       wanted.width, wanted.height, format_names(wanted));
  }
  mode->width = wanted.width;
  mode->height = wanted.height;
  auto result = set_mode(device, *mode);
  if (auto* const stream = std::get_if<V4l2Stream>(&result)) {
    stream->rate_hz = set_rate(device, wanted.rate_hz);
  }
  return result;
}

}  // namespace handeye
