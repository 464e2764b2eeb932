// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/replay.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "daemon/session/calibration.hpp"
#include "daemon/session/hand_stream.hpp"
#include "daemon/session/image_stage.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/session/tracking_ahead.hpp"
#include "drivers/recording/recording.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

// Only how often the progress is told.
constexpr std::int64_t kProgressEvery = 10;

/// All that the images themselves say: their size. Leaves the recording's camera at its second one.
CameraModel camera_of_unknown_lens(const Recording& recording, const ReplayOptions& options) {
  if (const auto problem = recording.camera->open()) throw InputError(*problem);
  Frame first;
  if (recording.camera->grab(first, std::chrono::milliseconds(0)) != GrabStatus::kFrame) {
    throw InputError(fmt::format("{}: has no images", options.recording.string()));
  }
  CameraModel camera;
  camera.width = first.grey.cols;
  camera.height = first.grey.rows;
  return camera;
}

/// False: only the size of its images is known.
bool knows_lens(const CameraModel& camera) {
  return camera.fx > 0;
}

CameraModel camera_for(const Recording& recording, const ReplayOptions& options) {
  if (options.camera_file) return read_camera_model(*options.camera_file);
  if (recording.camera_model) return *recording.camera_model;
  if (options.intrinsics == IntrinsicsMode::kEstimate && !options.board) {
    return camera_of_unknown_lens(recording, options);
  }
  throw InputError(fmt::format(
      "{}: has no camera.json; name the camera's with --camera FILE, or "
      "have the lens found with --intrinsics estimate{}",
      options.recording.string(), options.board ? " from a scene without a board" : ""));
}

cv::Mat mask_for(const Recording& recording, const ReplayOptions& options,
                 const CameraModel& camera) {
  cv::Mat mask = options.mask_file ? read_mask(*options.mask_file) : recording.mask;
  if (!mask.empty() && (mask.cols != camera.width || mask.rows != camera.height)) {
    throw InputError(fmt::format(
        "{}: the mask is {}x{}, the {} {}x{}",
        options.mask_file.value_or(options.recording).string(), mask.cols, mask.rows,
        knows_lens(camera) ? "camera file is for" : "images are", camera.width, camera.height));
  }
  return mask;
}

void require_size(const Frame& frame, const CameraModel& camera, const ReplayOptions& options) {
  if (frame.grey.cols == camera.width && frame.grey.rows == camera.height) return;
  if (!knows_lens(camera)) {
    throw InputError(fmt::format(
        "{}: its images begin as {}x{} and go on as {}x{}; record them at one size",
        options.recording.string(), camera.width, camera.height, frame.grey.cols, frame.grey.rows));
  }
  throw InputError(fmt::format(
      "{}: its images are {}x{}, but the camera file is for {}x{}; give the right one with "
      "--camera",
      options.recording.string(), frame.grey.cols, frame.grey.rows, camera.width, camera.height));
}

CalibrationOptions calibration_options(const ReplayOptions& options, const CameraModel& camera,
                                       std::size_t datagrams) {
  CalibrationOptions calibration;
  calibration.start.body_id = std::max(options.body_id, 0);
  calibration.start.wanted = options.wanted;
  calibration.start.board = options.board;
  calibration.camera = camera;
  calibration.intrinsics = options.intrinsics;
  calibration.hand_capacity = std::max<std::size_t>(datagrams, 1);
  return calibration;
}

/// The tracker's side of a recording, taken in as far as time has come.
class RecordedHand {
 public:
  RecordedHand(const std::vector<RecordedDatagram>& datagrams, int body_id)
      : next_(datagrams.begin()), end_(datagrams.end()), stream_(body_id) {}

  void feed_until(std::int64_t arrival_ns, Calibration& calibration) {
    for (; next_ != end_ && next_->arrival_ns <= arrival_ns; ++next_) {
      const auto sample = stream_.take({next_->arrival_ns, next_->bytes});
      if (sample) calibration.add_hand(*sample);
    }
  }
  int body_id() const { return std::max(stream_.body_id(), 0); }

 private:
  std::vector<RecordedDatagram>::const_iterator next_;
  std::vector<RecordedDatagram>::const_iterator end_;
  HandStream stream_;
};

}  // namespace

CalibrationResult replay(const ReplayOptions& options) {
  const Stopwatch stopwatch;
  Recording recording = open_recording(options.recording);
  const CameraModel camera = camera_for(recording, options);
  const auto images = make_image_stage(options.board, mask_for(recording, options, camera),
                                       known_lens(camera, options.intrinsics));
  RecordedHand hand(recording.datagrams, options.body_id);
  Calibration calibration(calibration_options(options, camera, recording.datagrams.size()));

  if (const auto problem = recording.camera->open()) throw InputError(*problem);
  TrackingAhead tracking(*recording.camera, *images,
                         [&](const Frame& frame) { require_size(frame, camera, options); });
  TrackedFrame tracked;
  std::int64_t frames_done = 0;
  while (tracking.next(tracked)) {
    hand.feed_until(tracked.timestamp_ns, calibration);
    calibration.add_frame(tracked);
    if (options.progress && ++frames_done % kProgressEvery == 0) options.progress(frames_done);
  }
  hand.feed_until(std::numeric_limits<std::int64_t>::max(), calibration);

  CalibrationResult result = calibration.solve();
  result.body_id = hand.body_id();
  result.frames.dropped = static_cast<std::int64_t>(recording.camera->counters().dropped);
  result.timings_ms.tracking = images->time_ms();
  result.timings_ms.total = stopwatch.elapsed_ms();
  return result;
}

}  // namespace handeye
