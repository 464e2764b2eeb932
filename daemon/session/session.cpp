// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/session.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

// A client repeats a request for some seconds; so many newer ones may come in between.
constexpr std::size_t kRememberedAcks = 256;
constexpr double kLongestDuration_s = 600;
constexpr int kLargestBodyId = 999;

std::optional<std::string> problem_with_start(const Request& request) {
  if (request.body_id < -1 || request.body_id > kLargestBodyId) {
    return "body_id must be 0 to 999, or -1 for the configured one";
  }
  if (!std::isfinite(request.wanted.rotation_deg) ||
      !std::isfinite(request.wanted.translation_mm)) {
    return "the wanted sigma must be numbers";
  }
  if (!std::isfinite(request.max_duration_s) || request.max_duration_s > kLongestDuration_s) {
    return "max_duration_s must be at most 600";
  }
  return std::nullopt;
}

double or_default(double wanted, double configured) {
  return wanted > 0 ? wanted : configured;
}

}  // namespace

Session::Command Session::on_request(const Request& request) {
  const auto known = std::ranges::find(acks_, request.request_id, &Ack::request_id);
  if (known != acks_.end()) {
    if (known->code != AckCode::kTaken) return Command::kNothing;
    if (request.action == Action::kDescribe && last_result_) return Command::kDescribe;
    return Command::kNothing;
  }
  Command command = Command::kNothing;
  remember(decide(request, command));
  return command;
}

void Session::refuse(const Ack& ack) {
  if (std::ranges::find(acks_, ack.request_id, &Ack::request_id) == acks_.end()) remember(ack);
}

void Session::remember(const Ack& ack) {
  acks_.push_front(ack);
  if (acks_.size() > kRememberedAcks) acks_.pop_back();
}

Ack Session::decide(const Request& request, Command& command) {
  switch (request.action) {
    case Action::kStart:
      return decide_start(request, command);
    case Action::kFinish:
    case Action::kCancel:
      return decide_end(request, command);
    case Action::kRecord:
      command = Command::kRecord;
      return {request.request_id, AckCode::kTaken, ""};
    case Action::kDescribe:
      break;
  }
  if (!last_result_) {
    return {request.request_id, AckCode::kNothingToDo, "there is no result yet"};
  }
  command = Command::kDescribe;
  return {request.request_id, AckCode::kTaken, ""};
}

Ack Session::decide_start(const Request& request, Command& command) {
  if (running()) {
    return {request.request_id, AckCode::kBusy,
            "calibration " + std::to_string(current_->request_id) +
                " is running; wait for it or cancel it"};
  }
  if (const auto problem = problem_with_start(request)) {
    return {request.request_id, AckCode::kBadRequest, *problem};
  }
  current_ = StartOptions{
      .request_id = request.request_id,
      .body_id = request.body_id >= 0 ? request.body_id : defaults_.body_id,
      .wanted = {or_default(request.wanted.rotation_deg, defaults_.wanted.rotation_deg),
                 or_default(request.wanted.translation_mm, defaults_.wanted.translation_mm)},
      .max_duration_s = or_default(request.max_duration_s, defaults_.max_duration_s),
      .board = request.board};
  state_ = SessionState::kCollecting;
  command = Command::kStart;
  return {request.request_id, AckCode::kTaken, ""};
}

Ack Session::decide_end(const Request& request, Command& command) {
  if (!running()) {
    return {request.request_id, AckCode::kNothingToDo, "no calibration is running"};
  }
  if (request.target_request_id != 0 && request.target_request_id != current_->request_id) {
    return {request.request_id, AckCode::kNothingToDo,
            "calibration " + std::to_string(request.target_request_id) + " is not running"};
  }
  command = request.action == Action::kFinish ? Command::kFinish : Command::kCancel;
  return {request.request_id, AckCode::kTaken, ""};
}

void Session::on_solving() {
  if (state_ == SessionState::kCollecting) state_ = SessionState::kSolving;
}

void Session::on_result(CalibrationResult result) {
  switch (result.verdict) {
    case Verdict::kAccepted:
      state_ = SessionState::kDone;
      break;
    case Verdict::kRefused:
      state_ = SessionState::kRefused;
      break;
    case Verdict::kCancelled:
      state_ = SessionState::kCancelled;
      break;
  }
  last_result_ = std::move(result);
}

bool Session::running() const {
  return state_ == SessionState::kCollecting || state_ == SessionState::kSolving;
}

}  // namespace handeye
