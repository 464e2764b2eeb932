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
  const ImageCondition condition = inspect(frame.grey);
  if (!shows_nothing(condition)) look(fields_.take(frame.grey), frame.timestamp_ns, tracked);
  // All images count, also those that the tracker was not given: gaps tell how time passes.
  tracked.index = frames_++;
  tracked.timestamp_ns = frame.timestamp_ns;
  const bool interlaced = condition == ImageCondition::kGood && fields_.used_one_field();
  tracked.condition = interlaced ? ImageCondition::kInterlaced : condition;
  time_ms_ += stopwatch.elapsed_ms();
}

ImageCondition ImageStage::inspect(const cv::Mat& grey) {
  if (!grey.empty() && grey.type() == CV_8UC1) return inspector_.inspect(grey);
  count_failure("the image is empty, or not of 8 bit grey");
  return ImageCondition::kDark;
}

std::unique_ptr<ImageStage> make_image_stage(const std::optional<Board>& board, cv::Mat mask) {
  if (board) return std::make_unique<BoardStage>(*board);
  return std::make_unique<TrackingStage>(std::move(mask));
}

}  // namespace handeye
