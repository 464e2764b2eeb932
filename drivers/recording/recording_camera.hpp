// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/camera.hpp"
#include "drivers/recording/frame_source.hpp"

namespace handeye {

/// A recording as a camera: hands out every frame in order, as fast as it is asked, then kEnd.
/// It starts at the first frame; open() goes back there. Time stamps are the recorded ones;
/// arrival_ns is the time stamp too, since recordings do not tell when a frame arrived.
///
/// A frame that cannot be read ends in an InputError from grab(): to skip it silently would make
/// the recording another one, and a recording that is wrong is an input error, not a lost device.
class RecordingCamera final : public Camera {
 public:
  RecordingCamera(std::filesystem::path path, std::unique_ptr<FrameSource> frames);

  std::optional<std::string> open() override;
  void close() override;
  GrabStatus grab(Frame& frame, std::chrono::milliseconds timeout) override;
  std::string description() const override;
  CameraCounters counters() const override { return counters_; }

 private:
  std::filesystem::path path_;
  std::unique_ptr<FrameSource> frames_;
  CameraCounters counters_;
  std::optional<std::uint32_t> last_sequence_;
};

}  // namespace handeye
