// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>

#include "daemon/service/solver_thread.hpp"
#include "daemon/session/calibration.hpp"
#include "daemon/session/steady_guidance.hpp"
#include "daemon/session/stopwatch.hpp"

namespace handeye {

/// The global adjustment needs the calibration itself: it goes along and comes back.
struct AdjustedCalibration {
  std::unique_ptr<Calibration> calibration;
  std::optional<CalibrationSnapshot> snapshot;  ///< nothing: it failed
};

/// A calibration while it collects.
struct SolverThread::Running {
  StartOptions start;
  std::uint64_t number;
  std::uint64_t drops_before;
  std::unique_ptr<Calibration> calibration;  ///< null: away for its global adjustment; frames wait
  Stopwatch since_start;
  double tracking_ms{0};
  bool finish_asked{false};
  bool cancel_asked{false};
  bool solving_told{false};

  std::future<Provisional> provisional;
  double provisional_begun_ms{0};
  double next_provisional_ms{500};
  Provisional last_provisional;
  SteadyGuidance guidance{SteadyGuidanceOptions{}};

  std::future<AdjustedCalibration> adjusting;  ///< first half of an attempt, or for itself
  bool promising{false};                       ///< the second half is worth while
  double adjusting_begun_ms{0};
  double next_adjustment_ms{5000};
  std::future<SolvedCalibration> attempt;  ///< second half
  double next_attempt_ms{0};

  double elapsed_ms() const { return since_start.elapsed_ms(); }
  /// Asked to, or out of time.
  bool is_ending() const { return finish_asked || elapsed_ms() > 1000 * start.max_duration_s; }
  /// Under way, or done and not fetched yet.
  bool has_background_work() const {
    return provisional.valid() || adjusting.valid() || attempt.valid();
  }
};

}  // namespace handeye
