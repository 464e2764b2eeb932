// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "daemon/geometry/board.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "daemon/tracking/feature_tracker.hpp"
#include "daemon/tracking/fields.hpp"
#include "daemon/tracking/image_inspector.hpp"
#include "drivers/camera.hpp"

namespace handeye {

/// From images to what an EyeSource takes, for one calibration. The same in the live daemon and in
/// a replay. One thread.
class ImageStage {
 public:
  ImageStage() = default;
  ImageStage(const ImageStage&) = delete;
  ImageStage& operator=(const ImageStage&) = delete;
  virtual ~ImageStage() = default;

  /// Frames in order of time, all of one size. In a dark or frozen one nothing is looked for; of an
  /// interlaced one only one field is used; one that OpenCV throws at is unusable and shows
  /// nothing.
  void process(const Frame& frame, TrackedFrame& tracked);

  /// Wall time spent so far [ms].
  double time_ms() const { return time_ms_; }

  /// Images that were unusable.
  std::int64_t failures() const { return failures_; }
  /// The last of them, in words.
  const std::string& failure() const { return failure_; }

 private:
  /// Fills in what is to be seen in an image that shows something: observations, descriptions.
  virtual void look(const cv::Mat& grey, std::int64_t timestamp_ns, TrackedFrame& tracked) = 0;

  ImageCondition see(const Frame& frame, TrackedFrame& tracked);
  void fail(std::string what, TrackedFrame& tracked);

  ImageInspector inspector_;
  FieldSeparation fields_;
  std::int64_t frames_{0};
  double time_ms_{0};
  std::int64_t failures_{0};
  std::string failure_;
};

/// Features of whatever is in view, or, given a board, its corners. `mask`: CV_8UC1, 255 = usable;
/// empty: it is found in the images, all along. A board needs none. `lens`: of the images, where it
/// is known beforehand.
std::unique_ptr<ImageStage> make_image_stage(const std::optional<Board>& board, cv::Mat mask,
                                             const std::optional<CameraModel>& lens = {});

}  // namespace handeye
