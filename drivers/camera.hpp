// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

namespace handeye {

/// One camera image. Reused from grab to grab: `grey` keeps its memory when size and type stay.
struct Frame {
  std::int64_t timestamp_ns{0};  ///< mid-exposure as the driver knows it, host CLOCK_MONOTONIC
  std::int64_t arrival_ns{0};    ///< when it reached this process, host CLOCK_MONOTONIC
  std::uint32_t sequence{0};     ///< the device's own count; wraps; a gap is a drop
  cv::Mat grey;                  ///< CV_8UC1, full resolution
};

enum class GrabStatus {
  kFrame,    ///< a new frame was written
  kTimeout,  ///< none within the time; the device is still there
  kLost,     ///< the device is gone or failed: close() and open() again later
  kEnd,      ///< a recording has been read to its end
};

/// Counted since construction; survives close() and open().
struct CameraCounters {
  std::uint64_t received{0};       ///< frames handed out
  std::uint64_t dropped{0};        ///< gaps in the device's own count
  std::uint64_t dropped_queue{0};  ///< lost in this process: a queue was full
  std::uint64_t malformed{0};      ///< frames that could not be decoded or had a wrong size
  std::uint64_t opened{0};         ///< successful open() calls
};

/// A source of frames. One thread opens, grabs and closes; nothing here is shared between threads.
class Camera {
 public:
  Camera() = default;
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;
  virtual ~Camera() = default;

  /// Starts the stream. Nothing on success; else why not, in one line for a person
  /// ("/dev/endoscope0: not there"). May be called again after a failure or after close().
  virtual std::optional<std::string> open() = 0;

  /// Stops and forgets the device. Safe at any time.
  virtual void close() = 0;

  /// Waits at most `timeout` for the next frame.
  virtual GrabStatus grab(Frame& frame, std::chrono::milliseconds timeout) = 0;

  /// What is being read and how, for STATUS: "/dev/video0 1280x720 NV12 60.0 Hz".
  virtual std::string description() const = 0;

  virtual CameraCounters counters() const = 0;
};

}  // namespace handeye
