// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

#include "drivers/camera.hpp"

namespace handeye {

/// What is known of a recording's frames once it has been looked through.
struct FrameSummary {
  std::size_t frames{0};  ///< at least 1
  cv::Size size;          ///< of every frame
  double rate_hz{0};      ///< mean; 0: only one frame
};

/// The frames of one kind of recording, in order. Checked on opening as far as can be without
/// decoding every image.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  virtual const FrameSummary& summary() const = 0;

  /// Writes the next frame; false after the last. Throws InputError when it cannot be read: the
  /// image is damaged, or the file has changed or vanished since it was opened.
  virtual bool next(Frame& frame) = 0;

  /// Back to the first frame.
  virtual void rewind() = 0;
};

}  // namespace handeye
