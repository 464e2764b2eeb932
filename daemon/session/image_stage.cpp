// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/image_stage.hpp"

#include <utility>

#include "daemon/session/board_stage.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/session/tracking_stage.hpp"

namespace handeye {

void ImageStage::process(const Frame& frame, TrackedFrame& tracked) {
  const Stopwatch stopwatch;
  tracked.observations.clear();
  tracked.descriptions.clear();
  tracked.condition = see(frame, tracked);
  // All images count, also those that the tracker was not given: gaps tell how time passes.
  tracked.index = frames_++;
  tracked.timestamp_ns = frame.timestamp_ns;
  time_ms_ += stopwatch.elapsed_ms();
}

/// What comes from a camera must not end the daemon, whatever it is.
ImageCondition ImageStage::see(const Frame& frame, TrackedFrame& tracked) {
  const ImageCondition condition = inspector_.inspect(frame.grey);
  if (condition == ImageCondition::kUnusable) {
    fail("it is empty, or not of 8 bit grey", tracked);
  }
  if (shows_nothing(condition)) return condition;
  try {
    look(fields_.take(frame.grey), frame.timestamp_ns, tracked);
  } catch (const cv::Exception& error) {
    fail(error.err, tracked);
    return ImageCondition::kUnusable;
  }
  const bool interlaced = condition == ImageCondition::kGood && fields_.used_one_field();
  return interlaced ? ImageCondition::kInterlaced : condition;
}

void ImageStage::fail(std::string what, TrackedFrame& tracked) {
  ++failures_;
  failure_ = std::move(what);
  tracked.observations.clear();
  tracked.descriptions.clear();
}

std::unique_ptr<ImageStage> make_image_stage(const std::optional<Board>& board, cv::Mat mask,
                                             const std::optional<CameraModel>& lens) {
  if (board) return std::make_unique<BoardStage>(*board);
  return std::make_unique<TrackingStage>(std::move(mask), lens);
}

}  // namespace handeye
