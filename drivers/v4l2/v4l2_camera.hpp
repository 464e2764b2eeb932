// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/camera.hpp"
#include "drivers/image/grey_decoder.hpp"
#include "drivers/v4l2/v4l2_buffers.hpp"
#include "drivers/v4l2/v4l2_device.hpp"
#include "drivers/v4l2/v4l2_modes.hpp"
#include "drivers/v4l2/v4l2_negotiation.hpp"

namespace handeye {

struct V4l2CameraOptions {
  std::string device{"/dev/endoscope0"};
  V4l2Wish wish;
  /// Half the exposure time: moves the driver's stamp, at the start or the end of exposure, to its
  /// middle. What is left constant is found by the time-offset estimation.
  std::int64_t half_exposure_ns{0};
  /// No frame for so long: the device counts as lost, and open() starts its stream anew.
  std::chrono::milliseconds silent_is_lost{3'000};
};

/// A camera behind a Linux video device (V4L2, streaming through mapped buffers; single- and
/// multiplanar). Frames that the driver marks as damaged, that are too short, whose JPEG does not
/// decode or whose stamp is not after the one before are counted as malformed and passed over.
///
/// When the device is unplugged, fails, changes its signal or falls silent, grab() closes it,
/// forgets everything about it and says kLost; open() finds it again by its path.
class V4l2Camera final : public Camera {
 public:
  explicit V4l2Camera(V4l2CameraOptions options);

  std::optional<std::string> open() override;
  void close() override;
  GrabStatus grab(Frame& frame, std::chrono::milliseconds timeout) override;
  std::string description() const override;
  CameraCounters counters() const override { return counters_; }

 private:
  enum class Ready { kFrame, kNothing, kFailed };

  std::optional<std::string> start();
  Ready take_next(V4l2Filled& filled, std::chrono::steady_clock::time_point deadline);
  bool signal_changed() const;
  bool convert(const V4l2Filled& filled, Frame& frame);
  GrabStatus lost();

  V4l2CameraOptions options_;
  CameraCounters counters_;
  V4l2Device device_;
  V4l2Buffers buffers_;  ///< after the device: unmapped before it is closed
  V4l2Stream stream_;
  GreyDecoder decoder_;
  std::optional<std::uint32_t> last_sequence_;
  std::int64_t last_timestamp_ns_{0};
  std::chrono::steady_clock::time_point last_frame_;
};

}  // namespace handeye
