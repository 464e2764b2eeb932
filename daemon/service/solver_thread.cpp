// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/solver_thread.hpp"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "daemon/session/stopwatch.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kWait{50};
constexpr double kAssessEvery_ms = 1000;
/// Meanwhile nobody takes the frames in, or hears a request: not more than a third of the time.
constexpr double kBetweenAttempts_ms = 3000;
constexpr double kBetweenAttempts_solves = 2;
// The estimate on the way lacks the global adjustment; ask for some margin before trying that.
constexpr double kAttemptMargin = 0.9;

/// What a lens that is being found adds only an attempt can tell.
bool is_promising(const CalibrationProgress& progress, const WantedSigma& wanted) {
  const auto& sigma = progress.sigma_beside_lens;
  return sigma && sigma->rotation_deg <= kAttemptMargin * wanted.rotation_deg &&
         sigma->translation_mm <= kAttemptMargin * wanted.translation_mm;
}

CalibrationResult cancelled(std::int64_t request_id) {
  CalibrationResult result;
  result.request_id = request_id;
  result.verdict = Verdict::kCancelled;
  result.reason = Reason::kCancelled;
  return result;
}

}  // namespace

/// A calibration while it collects.
struct SolverThread::Running {
  Calibration calibration;
  std::uint64_t number;
  Stopwatch since_start;
  double next_assessment_ms{kAssessEvery_ms};
  double next_attempt_ms;
  double tracking_ms{0};
  std::uint64_t drops_before;
  bool finish_asked{false};
  bool cancel_asked{false};

  double max_duration_ms() const { return 1000 * calibration.options().start.max_duration_s; }
};

SolverThread::SolverThread(BoundedQueue<HandSample>& hand_samples, Exchange<TrackedItem>& tracked,
                           const Options& options)
    : hand_samples_(hand_samples),
      tracked_(tracked),
      options_(options),
      commands_(64),
      events_(64) {}

void SolverThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void SolverThread::begin(const StartOptions& options, std::uint64_t calibration) {
  commands_.push({Command::Kind::kBegin, options, calibration});
}

void SolverThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto command = commands_.pop(kWait);
    if (command && command->kind == Command::Kind::kBegin) calibrate(*command, stop);
    // What the last calibration left behind.
    hand_samples_.clear();
    while (TrackedItem* item = tracked_.take(milliseconds(0))) tracked_.release(item);
  }
}

void SolverThread::calibrate(const Command& begin, const std::stop_token& stop) {
  set_progress({});
  Running running{.calibration = Calibration({.start = begin.start,
                                              .camera = options_.camera,
                                              .intrinsics = options_.intrinsics,
                                              .noise = options_.noise,
                                              .reconstruction = {}}),
                  .number = begin.calibration,
                  .since_start = {},
                  .next_attempt_ms = 1000 * options_.min_duration_s,
                  .drops_before = tracked_.dropped()};
  while (!stop.stop_requested()) {
    take_in(running, kWait);
    hear(running);
    if (running.cancel_asked) return post(cancelled(begin.start.request_id));
    const bool time_is_up = running.since_start.elapsed_ms() > running.max_duration_ms();
    if (running.finish_asked || time_is_up) return conclude(running, stop);
    if (running.since_start.elapsed_ms() > running.next_assessment_ms && assess(running)) return;
  }
}

void SolverThread::take_in(Running& running, milliseconds wait) {
  TrackedItem* item = tracked_.take(wait);
  while (const auto sample = hand_samples_.pop()) running.calibration.add_hand(*sample);
  if (item == nullptr) return;
  if (item->calibration == running.number) {
    running.calibration.add_frame(item->frame);
    running.tracking_ms = item->tracking_ms;
  }
  tracked_.release(item);
}

/// What was tracked before now, not what keeps coming.
void SolverThread::take_rest(Running& running, const std::stop_token& stop) {
  for (int waiting = tracked_.waiting(); waiting > 0 && !stop.stop_requested(); --waiting) {
    take_in(running, milliseconds(0));
    hear(running);
    if (running.cancel_asked) return;
  }
}

/// What was asked for since the last time.
void SolverThread::hear(Running& running) {
  while (const auto command = commands_.pop()) {
    running.finish_asked |= command->kind == Command::Kind::kFinish;
    running.cancel_asked |= command->kind == Command::Kind::kCancel;
  }
}

/// Tells how far we are; true when that was far enough and the result has been posted.
bool SolverThread::assess(Running& running) {
  const CalibrationProgress progress = running.calibration.progress();
  set_progress(progress);
  running.next_assessment_ms = running.since_start.elapsed_ms() + kAssessEvery_ms;
  if (running.since_start.elapsed_ms() < running.next_attempt_ms ||
      !is_promising(progress, running.calibration.options().start.wanted)) {
    return false;
  }
  const Stopwatch attempt;
  CalibrationResult result = solve(running);
  running.next_attempt_ms =
      running.since_start.elapsed_ms() +
      std::max(kBetweenAttempts_ms, kBetweenAttempts_solves * attempt.elapsed_ms());
  hear(running);
  if (running.cancel_asked || result.verdict != Verdict::kAccepted) return false;
  post(std::move(result));
  return true;
}

void SolverThread::conclude(Running& running, const std::stop_token& stop) {
  post(Solving{});
  take_rest(running, stop);
  if (stop.stop_requested()) return;
  std::optional<CalibrationResult> result;
  if (!running.cancel_asked) result = solve(running);
  hear(running);
  const std::int64_t request_id = running.calibration.options().start.request_id;
  post(running.cancel_asked ? cancelled(request_id) : std::move(*result));
}

CalibrationResult SolverThread::solve(Running& running) {
  CalibrationResult result = running.calibration.solve();
  result.timings_ms.tracking = running.tracking_ms;
  result.timings_ms.total = running.since_start.elapsed_ms();
  result.frames.dropped = static_cast<std::int64_t>(tracked_.dropped() - running.drops_before);
  return result;
}

void SolverThread::post(Event event) {
  events_.push(std::move(event));
  wake_up_.signal();
}

void SolverThread::set_progress(CalibrationProgress progress) {
  const std::scoped_lock lock(progress_mutex_);
  progress_ = std::move(progress);
}

CalibrationProgress SolverThread::progress() const {
  const std::scoped_lock lock(progress_mutex_);
  return progress_;
}

}  // namespace handeye
