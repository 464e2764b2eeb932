// SPDX-License-Identifier: BSD-3-Clause
#include "client/library/remote_calibration.hpp"

#include <utility>

namespace handeye {
namespace {

using std::chrono::milliseconds;

bool is_final(std::int32_t session_state) {
  return session_state == status_t::DONE || session_state == status_t::REFUSED ||
         session_state == status_t::CANCELLED;
}

CalibrationOutcome::Kind kind_of(const result_t& result) {
  switch (result.verdict) {
    case result_t::ACCEPTED:
      return CalibrationOutcome::Kind::kAccepted;
    case result_t::CANCELLED:
      return CalibrationOutcome::Kind::kCancelled;
    default:
      return CalibrationOutcome::Kind::kRefused;
  }
}

std::string seconds(milliseconds duration) {
  const auto tenths = (duration.count() + 50) / 100;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " s";
}

}  // namespace

RemoteCalibration::RemoteCalibration(Client& client, const StartRequest& wanted,
                                     const CalibrationLimits& limits,
                                     Client::StatusHandler on_status)
    : client_(client),
      limits_(limits),
      on_status_(std::move(on_status)),
      request_id_(client.start(wanted)),
      started_(Clock::now()) {
  client_.on_status([this](const status_t& status) { take_status(status); });
  client_.on_result([this](const result_t& result) { take_result(result); });
}

RemoteCalibration::~RemoteCalibration() {
  client_.on_status({});
  client_.on_result({});
  client_.abandon(request_id_);
  for (const auto& id : {describe_id_, finish_id_, cancel_id_}) {
    if (id) client_.abandon(*id);
  }
}

bool RemoteCalibration::spin_once(milliseconds timeout) {
  const bool handled = client_.spin_once(timeout);
  const auto now = Clock::now();
  if (!outcome_) ask_for_the_result(now);
  if (!outcome_) check_cancellation(now);
  if (!outcome_) check_limits(now);
  return handled;
}

void RemoteCalibration::finish() {
  if (finish_id_ || cancel_id_ || outcome_) return;
  finish_id_ = client_.finish(request_id_);
}

void RemoteCalibration::cancel() {
  if (cancel_id_ || outcome_) return;
  // A START that is still unheard must not be heard after the CANCEL.
  client_.stop_repeating(request_id_);
  cancel_id_ = client_.cancel(request_id_);
  cancelled_ = Clock::now();
}

void RemoteCalibration::take_status(const status_t& status) {
  last_status_ = Clock::now();
  if (on_status_) on_status_(status);
  if (outcome_) return;
  if (!acknowledgement_) take_acknowledgement();
  if (outcome_ || !acknowledgement_) return;
  if (status.session_id != acknowledgement_->daemon_session_id) {
    end(Kind::kDaemonRestarted,
        "the daemon was restarted while it calibrated; the calibration is lost, start it again");
    return;
  }
  if (status.request_id == request_id_ && status.max_duration_s > 0) {
    max_duration_ =
        std::chrono::ceil<milliseconds>(std::chrono::duration<double>(status.max_duration_s));
  }
  if (has_ended(status) && !result_due_) result_due_ = *last_status_ + limits_.describe_period;
}

void RemoteCalibration::take_acknowledgement() {
  acknowledgement_ = client_.acknowledgement(request_id_);
  if (acknowledgement_ && !acknowledgement_->taken()) {
    end(Kind::kRequestRefused, acknowledgement_->text);
  }
}

void RemoteCalibration::take_result(const result_t& result) {
  if (outcome_ || result.request_id != request_id_) return;
  end(kind_of(result), "");
  outcome_->result = result;
}

/// Ours is over when STATUS says so, or when it tells of another one after ours.
bool RemoteCalibration::has_ended(const status_t& status) {
  if (status.request_id == request_id_) {
    seen_running_ = true;
    seen_cancelled_ = status.session_state == status_t::CANCELLED;
    return is_final(status.session_state);
  }
  return seen_running_;
}

void RemoteCalibration::ask_for_the_result(Clock::time_point now) {
  if (!result_due_ || now < *result_due_) return;
  if (seen_cancelled_) {
    // Nothing in the RESULT of a cancelled calibration is worth waiting for.
    end(Kind::kCancelled, "cancelled");
    return;
  }
  if (describe_id_) client_.abandon(*describe_id_);
  // A new id each time: under the old one the daemon would rightly do nothing.
  describe_id_ = client_.describe();
  result_due_ = now + limits_.describe_period;
}

void RemoteCalibration::check_cancellation(Clock::time_point now) {
  if (!cancel_id_) return;
  const auto answer = client_.acknowledgement(*cancel_id_);
  if (!answer) {
    if (now - cancelled_ > limits_.acknowledgement) {
      end(Kind::kNotAcknowledged,
          "the daemon did not confirm the cancellation within " + seconds(limits_.acknowledgement));
    }
    return;
  }
  // It heard the CANCEL but never the START, which is no longer repeated: nothing runs.
  if (!acknowledgement_) end(Kind::kCancelled, "cancelled before the daemon had begun");
}

void RemoteCalibration::check_limits(Clock::time_point now) {
  const auto waited = now - started_;
  if (!last_status_) {
    if (waited > limits_.first_status) {
      end(Kind::kNoStatus, "no STATUS heard within " + seconds(limits_.first_status));
    }
    return;
  }
  if (!acknowledgement_) {
    if (!cancel_id_ && waited > limits_.acknowledgement) {
      end(Kind::kNotAcknowledged,
          "STATUS is heard, but the daemon did not acknowledge the request within " +
              seconds(limits_.acknowledgement));
    }
    return;
  }
  if (now - *last_status_ > limits_.silence) {
    end(Kind::kTimedOut, "the daemon fell silent: no STATUS for " + seconds(limits_.silence));
    return;
  }
  const milliseconds total = limits_.total.value_or(max_duration_ + limits_.solving);
  if (waited > total) {
    // Nobody will spin to repeat it: sent once.
    if (!cancel_id_) client_.abandon(client_.cancel(request_id_));
    end(Kind::kTimedOut, "no result within " + seconds(total) + "; the calibration was cancelled");
  }
}

void RemoteCalibration::end(Kind kind, std::string text) {
  outcome_ = CalibrationOutcome{kind, request_id_, std::move(text), std::nullopt, acknowledgement_};
  client_.abandon(request_id_);
}

CalibrationOutcome calibrate(Client& client, const StartRequest& wanted,
                             const CalibrationLimits& limits, Client::StatusHandler on_status) {
  RemoteCalibration calibration(client, wanted, limits, std::move(on_status));
  while (!calibration.outcome()) calibration.spin_once(milliseconds(50));
  return *calibration.outcome();
}

}  // namespace handeye
