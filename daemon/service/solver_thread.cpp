// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/solver_thread.hpp"

#include <algorithm>

#include "daemon/service/solver_thread_running.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kWait{50};
constexpr int kBackgroundNiceness = 5;
// Answers in the background may take this share of one processor.
constexpr double kBetweenProvisionals_ms = 500;
constexpr double kBetweenProvisionals_solves = 4;
constexpr double kBetweenAttempts_ms = 2000;
constexpr double kBetweenAttempts_solves = 2;
// Adjusting everything now and then leaves less to do when the answer is asked for.
constexpr double kBetweenAdjustments_ms = 5000;
// The provisional answer lacks the global adjustment, and half of the frames.
constexpr double kAttemptMargin = 1.1;

/// What a lens that is being found adds only an attempt can tell.
bool is_promising(const Provisional& answer, const WantedSigma& wanted) {
  const auto& sigma = answer.sigma_beside_lens;
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

SolverThread::SolverThread(BoundedQueue<HandSample>& hand_samples, Exchange<TrackedItem>& tracked,
                           const Options& options)
    : hand_samples_(hand_samples),
      tracked_(tracked),
      options_(options),
      commands_(64),
      events_(64),
      attempts_(kBackgroundNiceness) {}

void SolverThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void SolverThread::begin(const StartOptions& options, std::uint64_t calibration) {
  {
    const std::scoped_lock lock(progress_mutex_);
    progress_ = {};
  }
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
  const CalibrationOptions options{.start = begin.start,
                                   .camera = options_.camera,
                                   .intrinsics = options_.intrinsics,
                                   .noise = options_.noise,
                                   .hand_noise = options_.hand_noise,
                                   .reconstruction = {}};
  Running running{.start = begin.start,
                  .number = begin.calibration,
                  .drops_before = tracked_.dropped(),
                  .calibration = std::make_unique<Calibration>(options),
                  .next_provisional_ms = kBetweenProvisionals_ms,
                  .next_adjustment_ms = kBetweenAdjustments_ms,
                  .next_attempt_ms = 1000 * options_.min_duration_s};
  tell_progress(running);
  while (!stop.stop_requested()) {
    take_in(running, kWait);
    hear(running);
    if (running.cancel_asked) return post(cancelled(begin.start.request_id));
    if (end_background_work(running)) return;
    if (!running.calibration) continue;
    if (running.finish_asked || running.time_is_up()) return conclude(running, stop);
    tell_progress(running);
    begin_background_work(running);
  }
}

/// Everything of the hand that is there and one frame. False: none came.
bool SolverThread::take_in(Running& running, milliseconds wait) {
  if (!running.calibration) {
    running.adjusting.wait_for(wait);
    return false;
  }
  TrackedItem* item = tracked_.take(wait);
  while (const auto sample = hand_samples_.pop()) running.calibration->add_hand(*sample);
  if (item == nullptr) return false;
  if (item->calibration == running.number) {
    running.calibration->add_frame(item->frame);
    running.tracking_ms = item->tracking_ms;
  }
  tracked_.release(item);
  return true;
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

void SolverThread::tell_progress(Running& running) {
  CalibrationProgress progress{.situation = running.calibration->situation(),
                               .provisional = running.last_provisional,
                               .guidance = {}};
  progress.guidance = running.guidance.show(guidance_for(progress.situation, progress.provisional),
                                            1e-3 * running.elapsed_ms());
  const std::scoped_lock lock(progress_mutex_);
  progress_ = std::move(progress);
}

/// An attempt at the final answer where it may be good enough, or only its global adjustment when
/// the last one is long ago, else another provisional answer.
void SolverThread::begin_background_work(Running& running) {
  if (attempts_.busy()) return;
  const double now_ms = running.elapsed_ms();
  const bool promising = now_ms > running.next_attempt_ms &&
                         is_promising(running.last_provisional, running.start.wanted);
  if (promising || now_ms > running.next_adjustment_ms) {
    running.promising = promising;
    running.attempt_begun_ms = now_ms;
    running.next_adjustment_ms = now_ms + kBetweenAdjustments_ms;
    running.adjusting = attempts_.run([calibration = std::move(running.calibration)]() mutable {
      CalibrationSnapshot snapshot = calibration->snapshot();
      return AdjustedCalibration{std::move(calibration), std::move(snapshot)};
    });
  } else if (now_ms > running.next_provisional_ms && !running.provisional.valid()) {
    running.provisional_begun_ms = now_ms;
    running.provisional =
        attempts_.run([outline = running.calibration->outline()] { return provisional(outline); });
  }
}

/// Fetches what has been solved. True: a final answer, and the result has been posted.
bool SolverThread::end_background_work(Running& running) {
  if (is_ready(running.provisional)) end_provisional(running);
  if (is_ready(running.adjusting)) {
    AdjustedCalibration adjusted = running.adjusting.get();
    running.calibration = std::move(adjusted.calibration);
    if (running.promising && !running.finish_asked) {
      running.attempt = attempts_.run(
          [snapshot = std::move(adjusted.snapshot)] { return handeye::solve(snapshot); });
    }
  }
  return is_ready(running.attempt) && end_attempt(running);
}

void SolverThread::end_provisional(Running& running) {
  running.last_provisional = running.provisional.get();
  const double now_ms = running.elapsed_ms();
  running.next_provisional_ms =
      now_ms + std::max(kBetweenProvisionals_ms,
                        kBetweenProvisionals_solves * (now_ms - running.provisional_begun_ms));
}

/// Who asked to finish wants everything so far in the answer, which the attempt has not.
bool SolverThread::end_attempt(Running& running) {
  SolvedCalibration outcome = running.attempt.get();
  running.calibration->learn(outcome);
  const double now_ms = running.elapsed_ms();
  running.next_attempt_ms =
      now_ms +
      std::max(kBetweenAttempts_ms, kBetweenAttempts_solves * (now_ms - running.attempt_begun_ms));
  if (running.finish_asked || outcome.result.verdict != Verdict::kAccepted) return false;
  post_result(running, std::move(outcome.result));
  return true;
}

void SolverThread::conclude(Running& running, const std::stop_token& stop) {
  post(Solving{});
  take_rest(running, stop);
  std::optional<SolvedCalibration> outcome = solve_finally(running, stop);
  if (running.cancel_asked) return post(cancelled(running.start.request_id));
  if (outcome) post_result(running, std::move(outcome->result));
}

/// Nothing: cancelled, or stopped.
std::optional<SolvedCalibration> SolverThread::solve_finally(Running& running,
                                                             const std::stop_token& stop) {
  std::future<SolvedCalibration> answer;
  while (!running.cancel_asked && !stop.stop_requested()) {
    if (answer.valid()) {
      if (answer.wait_for(kWait) == std::future_status::ready) return answer.get();
    } else if (!final_answer_.busy()) {
      answer = final_answer_.run([calibration = std::move(running.calibration)] {
        return handeye::solve(calibration->snapshot());
      });
    } else {
      std::this_thread::sleep_for(kWait);
    }
    hear(running);
  }
  return std::nullopt;
}

void SolverThread::post_result(const Running& running, CalibrationResult result) {
  result.timings_ms.tracking = running.tracking_ms;
  result.timings_ms.total = running.elapsed_ms();
  result.frames.dropped = static_cast<std::int64_t>(tracked_.dropped() - running.drops_before);
  post(std::move(result));
}

void SolverThread::post(Event event) {
  events_.push(std::move(event));
  wake_up_.signal();
}

CalibrationProgress SolverThread::progress() const {
  const std::scoped_lock lock(progress_mutex_);
  return progress_;
}

}  // namespace handeye
