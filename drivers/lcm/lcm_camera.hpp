// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "drivers/camera.hpp"
#include "drivers/image/grey_decoder.hpp"
#include "drivers/image/image_message.hpp"
#include "drivers/lcm/image_ring.hpp"
#include "protocol/bus.hpp"
#include "protocol/channels.hpp"

namespace handeye {

struct LcmCameraOptions {
  std::string provider_url{kDefaultLcmProvider};
  std::string channel{Channels().frame};
  /// A time stamp must lie within these of the image's arrival; else the sender's clock is not this
  /// host's CLOCK_MONOTONIC and the image counts as malformed.
  std::chrono::milliseconds oldest_timestamp{10'000};
  std::chrono::milliseconds latest_timestamp{1'000};  ///< in the future
  /// True: stamps may be of any clock and go back; who grabs must look after them (FrameClock).
  bool any_clock{false};
};

/// A camera whose images another program publishes as image_t (GREY8 or JPEG) on an LCM channel.
///
/// Nothing in a message is trusted: an image that is not an image_t, whose fields or lengths are
/// out of range, whose time stamp is implausible or not after the one before (LcmCameraOptions), or
/// whose JPEG is damaged is counted as malformed and passed over. A gap in frame_number counts as
/// dropped, wherever the image got lost on its way; a new session_id starts a new count. While
/// images come faster than grab() is called, kQueueLength of them wait and the oldest go first
/// (dropped_queue).
///
/// A channel cannot be unplugged: grab() says kLost only before open() and after close().
class LcmCamera final : public Camera {
 public:
  static constexpr std::size_t kQueueLength = 8;

  explicit LcmCamera(LcmCameraOptions options);

  std::optional<std::string> open() override;
  void close() override;
  GrabStatus grab(Frame& frame, std::chrono::milliseconds timeout) override;
  std::string description() const override;
  CameraCounters counters() const override;

 private:
  /// What is known of the sender from its messages since open().
  struct Stream {
    std::int64_t session_id{0};
    std::int64_t frame_number{0};
    std::int64_t timestamp_ns{0};
    int width{0};  ///< px; 0: nothing heard yet
    int height{0};
    PixelFormat format{PixelFormat::kGrey};
    double period_s{0};  ///< running mean of the time between images; 0: not known yet
  };

  void receive(const CheckedImage& image);
  bool is_plausible(const image_t& image, std::int64_t arrival_ns) const;
  void follow(const image_t& image);
  bool take_oldest(Frame& frame);

  LcmCameraOptions options_;
  CameraCounters counters_;
  Stream stream_;
  ImageRing waiting_{kQueueLength};
  GreyDecoder decoder_;
  std::unique_ptr<Bus> bus_;  ///< empty: closed. After everything its callback uses.
};

}  // namespace handeye
