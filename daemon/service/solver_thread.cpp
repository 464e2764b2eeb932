// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/solver_thread.hpp"

#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/service/solver_thread_running.hpp"
#include "daemon/service/thread_role.hpp"
#include "daemon/session/stopwatch.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kWait{50};
constexpr int kBackgroundNiceness = 5;

CalibrationResult cancelled(const StartOptions& start) {
  CalibrationResult result;
  result.request_id = start.request_id;
  result.verdict = Verdict::kCancelled;
  result.reason = Reason::kCancelled;
  return result;
}

/// For an answer that failed in a way nobody foresaw; why is in the log.
CalibrationResult not_solved(const StartOptions& start) {
  CalibrationResult result;
  result.request_id = start.request_id;
  result.body_id = start.body_id;
  result.wanted = start.wanted;
  result.board = start.board;
  result.reason = Reason::kUncertain;
  result.advice = "the solver failed, see the daemon's log: calibrate again";
  return result;
}

/// Everything so far goes in. The result does not tell what the adjustment takes.
SolvedCalibration answer_of(Calibration& calibration) {
  const Stopwatch stopwatch;
  const CalibrationSnapshot snapshot = calibration.snapshot();
  spdlog::info("solver: the eye's last adjustment took {:.0f} ms", stopwatch.elapsed_ms());
  return handeye::solve(snapshot);
}

}  // namespace

SolverThread::SolverThread(BoundedQueue<HandItem>& hand, Exchange<TrackedItem>& tracked,
                           const Options& options)
    : hand_(hand),
      tracked_(tracked),
      options_(options),
      commands_(64),
      events_(64),
      attempts_("attempts", kBackgroundNiceness),
      final_answer_("final answer") {}

void SolverThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    take_role({.name = "solver"});
    run(stop);
  });
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
    heartbeat_.beat();
    const auto command = commands_.pop(kWait);
    if (!command) forget_leftovers();
    if (command && command->kind == Command::Kind::kBegin) calibrate(*command, stop);
  }
}

/// Makes room: what the last calibration left behind.
void SolverThread::forget_leftovers() {
  hand_.clear();
  while (TrackedItem* item = tracked_.take(milliseconds(0))) tracked_.release(item);
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
                  .next_attempt_ms = 1000 * options_.min_duration_s};
  tell_progress(running);
  while (!stop.stop_requested()) {
    take_in(running, kWait);
    hear(running);
    if (running.cancel_asked) return post(cancelled(begin.start));
    if (end_background_work(running)) return;
    if (running.is_ending()) tell_solving(running);
    if (!running.calibration) continue;
    if (running.is_ending()) return conclude(running, stop);
    tell_progress(running);
    begin_background_work(running);
  }
}

/// Everything of the hand that is there and one frame, as far as they are this calibration's: what
/// the one before left behind is dropped.
void SolverThread::take_in(Running& running, milliseconds wait) {
  if (!running.calibration) {
    running.adjusting.wait_for(wait);
    return;
  }
  TrackedItem* item = tracked_.take(wait);
  while (const auto hand = hand_.pop()) {
    if (hand->calibration == running.number) running.calibration->add_hand(hand->sample);
  }
  if (item == nullptr) return;
  if (item->calibration == running.number) {
    running.calibration->add_frame(item->frame);
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
  heartbeat_.beat();
  while (const auto command = commands_.pop()) {
    running.finish_asked |= command->kind == Command::Kind::kFinish;
    running.cancel_asked |= command->kind == Command::Kind::kCancel;
  }
}

void SolverThread::conclude(Running& running, const std::stop_token& stop) {
  take_rest(running, stop);
  std::optional<CalibrationResult> result = solve_finally(running, stop);
  if (running.cancel_asked) return post(cancelled(running.start));
  if (result) post_result(running, std::move(*result));
}

/// Nothing: cancelled, or stopped.
std::optional<CalibrationResult> SolverThread::solve_finally(Running& running,
                                                             const std::stop_token& stop) {
  std::future<SolvedCalibration> answer;
  while (!running.cancel_asked && !stop.stop_requested()) {
    if (!answer.valid() && !final_answer_.busy()) {
      answer = final_answer_.run(
          [calibration = std::move(running.calibration)] { return answer_of(*calibration); });
    } else if (!answer.valid()) {
      std::this_thread::sleep_for(kWait);  // one that was cancelled goes on to its end
    } else if (answer.wait_for(kWait) == std::future_status::ready) {
      auto outcome = outcome_of(answer, "the answer");
      return outcome ? std::move(outcome->result) : not_solved(running.start);
    }
    hear(running);
  }
  return std::nullopt;
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

/// Once.
void SolverThread::tell_solving(Running& running) {
  if (!std::exchange(running.solving_told, true)) post(Solving{});
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
