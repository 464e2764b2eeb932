// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "daemon/geometry/board.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

enum class SessionState { kIdle, kCollecting, kSolving, kDone, kRefused, kCancelled };

enum class Action { kStart, kFinish, kCancel, kDescribe, kRecord };

/// What a client asked, as request_t says it, already known to be one of the actions.
struct Request {
  std::int64_t request_id{0};
  Action action{Action::kStart};
  std::int64_t target_request_id{0};  ///< finish, cancel: 0 is whichever runs
  int body_id{-1};                    ///< start: -1 is the configured one
  WantedSigma wanted{0, 0};           ///< start: a value <= 0 is the configured one
  double max_duration_s{0};           ///< start, record: <= 0 is the configured one
  std::optional<Board> board;         ///< start: the eye's poses from it; nothing: reconstruct
};

enum class AckCode { kTaken, kBusy, kBadRequest, kNothingToDo };

/// What became of a request; STATUS carries the last ones.
struct Ack {
  std::int64_t request_id{0};
  AckCode code{AckCode::kTaken};
  std::string text;  ///< why not, in one line; empty when taken
};

/// What a calibration was started with, defaults filled in.
struct StartOptions {
  std::int64_t request_id{0};
  int body_id{0};
  WantedSigma wanted;
  double max_duration_s{30};
  std::optional<Board> board;  ///< the eye's poses from it; nothing: from a reconstruction
};

struct SessionDefaults {
  int body_id{0};
  WantedSigma wanted;
  double max_duration_s{30};
};

/// The one calibration that may run at a time, and the requests about it: who asked what, what
/// became of it, which state it is in. Pure: knows no thread, no clock, no LCM; the caller carries
/// out the returned commands and reports back. Not synchronised: one owner.
class Session {
 public:
  explicit Session(const SessionDefaults& defaults) : defaults_(defaults) {}

  /// What the caller has to do about a request.
  enum class Command { kNothing, kStart, kFinish, kCancel, kDescribe, kRecord };

  /// Takes a request. A request_id that was heard before is not acted on again; only a repeated
  /// describe is carried out once more, for its answer may have been lost.
  Command on_request(const Request& request);

  /// Remembers a request that could not even be read, for STATUS to say so.
  void refuse(const Ack& ack);

  /// The final solve has begun.
  void on_solving();
  /// The running calibration ended; its result is kept for describe.
  void on_result(CalibrationResult result);

  /// A result from before a restart, kept for describe. Only while nothing has been started.
  void on_restored(CalibrationResult result) { last_result_ = std::move(result); }

  SessionState state() const { return state_; }
  /// The calibration that runs or ran last. Null: none since start.
  const StartOptions* current() const { return current_ ? &*current_ : nullptr; }
  const CalibrationResult* last_result() const { return last_result_ ? &*last_result_ : nullptr; }
  /// Newest first.
  const std::deque<Ack>& acks() const { return acks_; }

 private:
  Ack decide(const Request& request, Command& command);
  Ack decide_start(const Request& request, Command& command);
  Ack decide_end(const Request& request, Command& command);
  void remember(const Ack& ack);
  bool running() const;

  SessionDefaults defaults_;
  SessionState state_{SessionState::kIdle};
  std::optional<StartOptions> current_;
  std::optional<CalibrationResult> last_result_;
  std::deque<Ack> acks_;
};

}  // namespace handeye
