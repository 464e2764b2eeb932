// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "client/library/client.hpp"

namespace handeye {

/// How long to wait for what.
struct CalibrationLimits {
  /// No STATUS at all within this time: there is no daemon.
  std::chrono::milliseconds first_status{2000};
  /// STATUS is heard but does not carry the request within this time.
  std::chrono::milliseconds acknowledgement{5000};
  /// After the acknowledgement: STATUS fell silent for this long.
  std::chrono::milliseconds silence{5000};
  /// After the calibration ended without a RESULT: DESCRIBE, and again at this period.
  std::chrono::milliseconds describe_period{500};
  /// From the START until the RESULT; nothing: the longest duration that STATUS tells, and
  /// `solving` on top.
  std::optional<std::chrono::milliseconds> total;
  std::chrono::milliseconds solving{30000};
};

/// How a calibration ended for the client.
struct CalibrationOutcome {
  enum class Kind {
    kAccepted,         ///< `result` is the accepted calibration
    kRefused,          ///< `result` says why; its estimate must not be used
    kCancelled,        ///< confirmed by the daemon; `result` may be there
    kRequestRefused,   ///< the daemon did not take the START; `acknowledgement` and `text` say why
    kNoStatus,         ///< no daemon heard
    kNotAcknowledged,  ///< a daemon is there but did not answer the request in time
    kTimedOut,         ///< no RESULT in time although the request had been acknowledged
    kDaemonRestarted,  ///< the daemon that ran the calibration is gone: start again
  };

  Kind kind{Kind::kNoStatus};
  std::int64_t request_id{0};
  std::string text;  ///< one line: what happened and what to do; empty with a result
  std::optional<result_t> result;
  std::optional<Acknowledgement> acknowledgement;  ///< of the START
};

/// One calibration from START to RESULT. Drive it with spin_once() until outcome() is there.
///
/// LCM may lose the RESULT, which the daemon sends once: when STATUS says that the calibration has
/// ended and no RESULT came, the client asks for it with DESCRIBE until it comes. The START itself
/// is never repeated under another id, so one object causes at most one calibration.
///
/// While it lives it owns the client's two handlers. At a time-out after the acknowledgement it
/// tells the daemon to cancel, since nobody waits any more.
class RemoteCalibration {
 public:
  using Kind = CalibrationOutcome::Kind;

  /// Sends START. on_status may be empty; it is called with every STATUS heard.
  RemoteCalibration(Client& client, const StartRequest& wanted,
                    const CalibrationLimits& limits = {}, Client::StatusHandler on_status = {});
  ~RemoteCalibration();
  RemoteCalibration(const RemoteCalibration&) = delete;
  RemoteCalibration& operator=(const RemoteCalibration&) = delete;

  /// Waits at most `timeout` for one message and acts on it and on what has become due.
  /// True: a message was handled, there may be more.
  bool spin_once(std::chrono::milliseconds timeout);

  /// Asks for the solution from what has been collected so far. The outcome comes as usual.
  void finish();

  /// Asks the daemon to cancel; the outcome is kCancelled once it confirmed, or the result if that
  /// was faster. Calling it again changes nothing.
  void cancel();

  std::int64_t request_id() const { return request_id_; }
  const std::optional<CalibrationOutcome>& outcome() const { return outcome_; }

 private:
  using Clock = std::chrono::steady_clock;

  void take_status(const status_t& status);
  void take_result(const result_t& result);
  void take_acknowledgement();
  bool has_ended(const status_t& status);
  void ask_for_the_result(Clock::time_point now);
  void check_limits(Clock::time_point now);
  void check_cancellation(Clock::time_point now);
  void end(Kind kind, std::string text);

  Client& client_;
  CalibrationLimits limits_;
  Client::StatusHandler on_status_;
  std::int64_t request_id_;
  Clock::time_point started_;
  std::optional<Clock::time_point> last_status_;
  std::optional<Acknowledgement> acknowledgement_;
  bool seen_running_{false};                     ///< STATUS has named our request at least once
  bool seen_cancelled_{false};                   ///< STATUS has called our request cancelled
  std::optional<Clock::time_point> result_due_;  ///< ended: when to ask for the RESULT
  std::optional<std::int64_t> describe_id_;
  std::optional<std::int64_t> finish_id_;
  std::optional<std::int64_t> cancel_id_;
  Clock::time_point cancelled_;                ///< when cancel() was called
  std::chrono::milliseconds max_duration_{0};  ///< as STATUS tells it
  std::optional<CalibrationOutcome> outcome_;
};

/// Runs a calibration and waits for its end: for programs that have nothing else to do.
CalibrationOutcome calibrate(Client& client, const StartRequest& wanted,
                             const CalibrationLimits& limits = {},
                             Client::StatusHandler on_status = {});

}  // namespace handeye
