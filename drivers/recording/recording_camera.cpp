// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/recording_camera.hpp"

#include <fmt/format.h>

#include "drivers/image/sequence_gap.hpp"

namespace handeye {

RecordingCamera::RecordingCamera(std::filesystem::path path, std::unique_ptr<FrameSource> frames)
    : path_(std::move(path)), frames_(std::move(frames)) {}

std::optional<std::string> RecordingCamera::open() {
  frames_->rewind();
  last_sequence_.reset();
  ++counters_.opened;
  return std::nullopt;
}

void RecordingCamera::close() {}

GrabStatus RecordingCamera::grab(Frame& frame, std::chrono::milliseconds /*timeout*/) {
  if (!frames_->next(frame)) return GrabStatus::kEnd;
  ++counters_.received;
  if (last_sequence_) counters_.dropped += sequence_gap(*last_sequence_, frame.sequence);
  last_sequence_ = frame.sequence;
  return GrabStatus::kFrame;
}

std::string RecordingCamera::description() const {
  const FrameSummary& summary = frames_->summary();
  return fmt::format("recording {} {}x{} {:.1f} Hz, {} frames", path_.string(), summary.size.width,
                     summary.size.height, summary.rate_hz, summary.frames);
}

}  // namespace handeye
