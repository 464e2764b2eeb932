// SPDX-License-Identifier: BSD-3-Clause
// What the solver thread has solved behind it while it takes frames in.
#include <algorithm>
#include <exception>

#include <spdlog/spdlog.h>

#include "daemon/service/solver_thread_running.hpp"

namespace handeye {
namespace {

// Answers in the background may take this share of one processor, ...
constexpr double kBetweenProvisionals_ms = 500;
constexpr double kBetweenProvisionals_solves = 4;
constexpr double kBetweenAttempts_ms = 2000;
constexpr double kBetweenAttempts_solves = 2;
// ... and adjusting everything now and then, which leaves less to do when the answer is asked for,
// this one: frames wait for it.
constexpr double kBetweenAdjustments_ms = 5000;
constexpr double kBetweenAdjustments_solves = 4;
// The provisional answer lacks the global adjustment, and half of the frames.
constexpr double kAttemptMargin = 1.1;

/// What a lens that is being found adds only an attempt can tell.
bool is_promising(const Provisional& answer, const WantedSigma& wanted) {
  const auto& sigma = answer.sigma_beside_lens;
  return sigma && sigma->rotation_deg <= kAttemptMargin * wanted.rotation_deg &&
         sigma->translation_mm <= kAttemptMargin * wanted.translation_mm;
}

/// The calibration comes back whatever happens.
AdjustedCalibration adjust(std::unique_ptr<Calibration>& calibration) {
  std::optional<CalibrationSnapshot> snapshot;
  try {
    snapshot = calibration->snapshot();
  } catch (const std::exception& error) {
    spdlog::error("a global adjustment failed: {}", error.what());
  }
  return {std::move(calibration), std::move(snapshot)};
}

/// When the like of what was begun then, and is done, may be begun again.
double next_ms(double begun_ms, double now_ms, double least_ms, double solves) {
  return now_ms + std::max(least_ms, solves * (now_ms - begun_ms));
}

}  // namespace

/// An attempt at the final answer where it may be good enough, or only its global adjustment when
/// the last one is long ago, else another provisional answer. One after the other, and each only
/// once the one before has been fetched: it may have come since this was looked for.
void SolverThread::begin_background_work(Running& running) {
  if (attempts_.busy() || running.has_background_work()) return;
  const double now_ms = running.elapsed_ms();
  const bool promising = now_ms > running.next_attempt_ms &&
                         is_promising(running.last_provisional, running.start.wanted);
  if (promising || now_ms > running.next_adjustment_ms) {
    running.promising = promising;
    running.adjusting_begun_ms = now_ms;
    running.adjusting = attempts_.run(
        [calibration = std::move(running.calibration)]() mutable { return adjust(calibration); });
  } else if (now_ms > running.next_provisional_ms) {
    running.provisional_begun_ms = now_ms;
    running.provisional =
        attempts_.run([outline = running.calibration->outline()] { return provisional(outline); });
  }
}

/// Fetches what has been solved. True: a final answer, and the result has been posted.
bool SolverThread::end_background_work(Running& running) {
  if (is_ready(running.provisional)) end_provisional(running);
  if (is_ready(running.adjusting)) end_adjustment(running);
  return is_ready(running.attempt) && end_attempt(running);
}

void SolverThread::end_provisional(Running& running) {
  const auto answer = outcome_of(running.provisional, "a provisional answer");
  if (answer) running.last_provisional = *answer;
  running.next_provisional_ms = next_ms(running.provisional_begun_ms, running.elapsed_ms(),
                                        kBetweenProvisionals_ms, kBetweenProvisionals_solves);
}

void SolverThread::end_adjustment(Running& running) {
  AdjustedCalibration adjusted = running.adjusting.get();
  running.calibration = std::move(adjusted.calibration);
  running.next_adjustment_ms = next_ms(running.adjusting_begun_ms, running.elapsed_ms(),
                                       kBetweenAdjustments_ms, kBetweenAdjustments_solves);
  if (!running.promising || !adjusted.snapshot || running.is_ending()) return;
  running.attempt = attempts_.run(
      [snapshot = std::move(*adjusted.snapshot)] { return handeye::solve(snapshot); });
}

/// Who asked to finish wants everything so far in the answer, which the attempt has not.
bool SolverThread::end_attempt(Running& running) {
  auto outcome = outcome_of(running.attempt, "an attempt at the answer");
  running.next_attempt_ms = next_ms(running.adjusting_begun_ms, running.elapsed_ms(),
                                    kBetweenAttempts_ms, kBetweenAttempts_solves);
  if (!outcome) return false;
  running.calibration->learn(*outcome);
  if (running.finish_asked || outcome->result.verdict != Verdict::kAccepted) return false;
  post_result(running, std::move(outcome->result));
  return true;
}

}  // namespace handeye
