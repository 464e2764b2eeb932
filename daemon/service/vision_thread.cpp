// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/vision_thread.hpp"

#include <algorithm>
#include <ctime>
#include <iterator>

#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>

#include "daemon/service/status_message.hpp"
#include "daemon/service/thread_role.hpp"

namespace handeye {
namespace {

constexpr std::chrono::milliseconds kWait{100};
// Below 100 kB for any endoscope image up to 1280x720; see image_t.lcm.
constexpr int kJpegQuality = 80;
// Of a core that tracking for the watch may take, and how often it does: features are lost where
// frames are too far apart, and more than this tells no more.
constexpr double kWatchShare = 0.15;
constexpr std::int64_t kShortestWatch_ns = 60'000'000;
constexpr std::int64_t kLongestWatch_ns = 200'000'000;
constexpr std::size_t kWatchedInFlight = 32;

/// Of this thread: what it takes must not seem more where others keep the processor busy.
std::int64_t processor_time_ns() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return 1'000'000'000 * static_cast<std::int64_t>(spent.tv_sec) + spent.tv_nsec;
}

}  // namespace

VisionThread::VisionThread(Exchange<Frame>& frames, Bus& bus, Options options)
    : frames_(frames),
      options_(std::move(options)),
      jpeg_options_{cv::IMWRITE_JPEG_QUALITY, kJpegQuality},
      tracked_(options_.tracked_in_flight),
      watched_(kWatchedInFlight) {
  if (options_.frame_channel) publisher_.emplace(bus, *options_.frame_channel);
}

void VisionThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    take_role({.name = "vision"});
    run(stop);
  });
}

std::uint64_t VisionThread::begin_collecting(const std::optional<Board>& board) {
  {
    const std::scoped_lock lock(begin_mutex_);
    board_ = board;
  }
  frames_collected_ = 0;
  features_tracked_ = 0;
  collecting_ = ++last_calibration_;
  return last_calibration_;
}

void VisionThread::begin_watching(const CameraModel& lens) {
  {
    const std::scoped_lock lock(begin_mutex_);
    watched_lens_ = lens;
  }
  watching_ = true;
}

void VisionThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    heartbeat_.beat();
    Frame* frame = frames_.take(kWait);
    if (frame == nullptr) continue;
    // First, for a search may take long, and a recording should have every frame.
    if (publisher_ && monotonic_ns() < record_until_ns_) publish(*frame);
    health_.add(look(*frame));
    report_picture();
    frames_.release(frame);
  }
}

ImageCondition VisionThread::look(const Frame& frame) {
  const std::uint64_t calibration = collecting_;
  if (calibration != 0) {
    watch_stage_.reset();
    const ImageCondition condition = track(frame, calibration);
    interlaced_ = health_.recently_interlaced();
    return condition;
  }
  if (watching_ && is_watch_due(frame)) return track_for_watch(frame);
  return inspector_.inspect(frame.grey);
}

/// Not while frames wait, and never for more than its share of the time.
bool VisionThread::is_watch_due(const Frame& frame) const {
  return frames_.waiting() == 0 && frame.timestamp_ns >= next_watch_ns_;
}

ImageCondition VisionThread::track_for_watch(const Frame& frame) {
  if (!watch_stage_) {
    const std::scoped_lock lock(begin_mutex_);
    watch_stage_ = make_image_stage({}, options_.mask.clone(), watched_lens_);
    ++watch_tracking_;
  }
  const std::int64_t before_ns = processor_time_ns();
  TrackedItem* item = watched_.acquire();
  TrackedFrame& target = item != nullptr ? item->frame : watch_overflow_;
  watch_stage_->process(frame, target);
  const auto spent_ns = static_cast<double>(processor_time_ns() - before_ns);
  next_watch_ns_ =
      frame.timestamp_ns + std::clamp(static_cast<std::int64_t>(spent_ns / kWatchShare),
                                      kShortestWatch_ns, kLongestWatch_ns);
  const ImageCondition condition = target.condition;
  if (item == nullptr) {
    watched_.count_drop();
  } else {
    item->calibration = watch_tracking_;
    watched_.commit(item);
  }
  return condition;
}

/// Says it when something begins or ceases to ail the picture; blur comes and goes with the hand.
void VisionThread::report_picture() {
  ImageCondition now = health_.recent();
  if (now == ImageCondition::kGood && interlaced_) now = ImageCondition::kInterlaced;
  const ImageCondition before = picture_.exchange(now);
  if (now == before || now == ImageCondition::kBlurred || before == ImageCondition::kBlurred)
    return;
  if (now == ImageCondition::kGood) {
    if (before == ImageCondition::kInterlaced) return;
    spdlog::info("camera: the picture is good again");
  } else {
    spdlog::warn("camera: {}", picture_text(now));
  }
}

void VisionThread::begin_stage(std::uint64_t calibration) {
  const std::scoped_lock lock(begin_mutex_);
  stage_ = make_image_stage(board_, options_.mask.clone(), options_.lens);
  staged_calibration_ = calibration;
  health_ = {};
  missed_descriptions_.clear();
}

ImageCondition VisionThread::track(const Frame& frame, std::uint64_t calibration) {
  if (calibration != staged_calibration_) begin_stage(calibration);
  TrackedItem* item = tracked_.acquire();
  // The tracker must see every frame, also one that the solver has no room for.
  TrackedFrame& target = item != nullptr ? item->frame : overflow_;
  process(frame, target);
  features_tracked_ = static_cast<int>(target.observations.size());
  ++frames_collected_;
  const ImageCondition condition = target.condition;
  if (item == nullptr) {
    tracked_.count_drop();
    missed_descriptions_.insert(missed_descriptions_.end(), overflow_.descriptions.begin(),
                                overflow_.descriptions.end());
    return condition;
  }
  catch_up_on_descriptions(item->frame);
  item->calibration = calibration;
  item->tracking_ms = stage_->time_ms();
  tracked_.commit(item);
  return condition;
}

/// A feature is described once in its life: what the solver missed it gets late, of those that are
/// still alive.
void VisionThread::catch_up_on_descriptions(TrackedFrame& tracked) {
  if (missed_descriptions_.empty() || shows_nothing(tracked.condition)) return;
  std::ranges::copy_if(missed_descriptions_, std::back_inserter(tracked.descriptions),
                       [&](const FeatureDescription& missed) {
                         return std::ranges::binary_search(tracked.observations, missed.feature_id,
                                                           {}, &Observation::feature_id);
                       });
  missed_descriptions_.clear();
}

void VisionThread::process(const Frame& frame, TrackedFrame& tracked) {
  const std::int64_t failures = stage_->failures();
  stage_->process(frame, tracked);
  // Once a calibration: what ails one image ails the next.
  if (failures == 0 && stage_->failures() > 0) {
    spdlog::warn("camera: an image could not be used: {}", stage_->failure());
  }
}

void VisionThread::publish(const Frame& frame) {
  if (frame.grey.empty()) return;
  if (!cv::imencode(".jpg", frame.grey, message_.data, jpeg_options_)) return;
  message_.timestamp_ns = frame.timestamp_ns;
  message_.frame_number = frame.sequence;
  message_.width = frame.grey.cols;
  message_.height = frame.grey.rows;
  message_.pixel_format = image_t::JPEG;
  message_.size = static_cast<std::int32_t>(message_.data.size());
  publisher_->publish(message_);
}

}  // namespace handeye
