// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/status_message.hpp"

#include <algorithm>
#include <array>

namespace handeye {
namespace {

constexpr std::size_t kAcksInStatus = 16;

static_assert(static_cast<int>(GuideCode::kHandHidden) == status_t::GUIDE_HAND_HIDDEN);
static_assert(static_cast<int>(GuideCode::kWholeBoard) == status_t::GUIDE_WHOLE_BOARD);
static_assert(static_cast<int>(GuideCode::kTiltUpAndDown) == status_t::GUIDE_TILT_UP_AND_DOWN);
static_assert(static_cast<int>(GuideCode::kKeepMoving) == status_t::GUIDE_KEEP_MOVING);

std::int32_t state_code(SessionState state) {
  switch (state) {
    case SessionState::kIdle:
      return status_t::IDLE;
    case SessionState::kCollecting:
      return status_t::COLLECTING;
    case SessionState::kSolving:
      return status_t::SOLVING;
    case SessionState::kDone:
      return status_t::DONE;
    case SessionState::kRefused:
      return status_t::REFUSED;
    case SessionState::kCancelled:
      return status_t::CANCELLED;
  }
  return status_t::IDLE;
}

std::int32_t ack_code(AckCode code) {
  switch (code) {
    case AckCode::kTaken:
      return status_t::ACK_TAKEN;
    case AckCode::kBusy:
      return status_t::ACK_BUSY;
    case AckCode::kBadRequest:
      return status_t::ACK_BAD_REQUEST;
    case AckCode::kNothingToDo:
      return status_t::ACK_NOTHING_TO_DO;
  }
  return status_t::ACK_BAD_REQUEST;
}

std::optional<Action> action_of(std::int32_t code) {
  switch (code) {
    case request_t::START:
      return Action::kStart;
    case request_t::FINISH:
      return Action::kFinish;
    case request_t::CANCEL:
      return Action::kCancel;
    case request_t::DESCRIBE:
      return Action::kDescribe;
    case request_t::RECORD:
      return Action::kRecord;
    default:
      return std::nullopt;
  }
}

/// How near sigma is to what is wanted: it falls roughly with the square root of time.
double sigma_progress(const Provisional& answer, const WantedSigma& wanted) {
  if (!answer.sigma) return 0;
  const double ratio = std::min(wanted.rotation_deg / answer.sigma->rotation_deg,
                                wanted.translation_mm / answer.sigma->translation_mm);
  return ratio * ratio;
}

/// Wanted sigma or time limit, whichever is nearer. Before `min_duration_s` no sigma ends anything,
/// and a sigma that is small enough is still to be confirmed by a whole answer.
double overall_progress(const Provisional& answer, const ProgressTerms& terms) {
  constexpr double kUnconfirmed = 0.99;
  const double by_sigma = std::min({sigma_progress(answer, terms.wanted), kUnconfirmed,
                                    terms.elapsed_s / std::max(terms.min_duration_s, 1e-3)});
  return std::clamp(std::max(by_sigma, terms.elapsed_s / terms.max_duration_s), 0.0, 1.0);
}

void write_provisional(const Provisional& answer, status_t& status) {
  status.sigma_rotation_deg = answer.sigma ? answer.sigma->rotation_deg : -1;
  status.sigma_translation_mm = answer.sigma ? answer.sigma->translation_mm : -1;
  status.time_offset_s = answer.time_offset_s;
  status.time_offset_sigma_s = answer.time_offset_sigma_s.value_or(-1);
  status.time_offset_confidence = answer.time_offset_confidence;
  std::copy_n(answer.turned_deg.data(), 3, status.turned_deg);
  if (!answer.solution) return;
  status.has_estimate = true;
  const Pose& hand_from_eye = answer.solution->hand_from_eye;
  const Eigen::Quaterniond q(hand_from_eye.linear());
  const double q_wxyz[4]{q.w(), q.x(), q.y(), q.z()};
  std::copy_n(q_wxyz, 4, status.q_wxyz);
  std::copy_n(hand_from_eye.translation().data(), 3, status.t_mm);
}

/// What a START is to look at. False, and why: the request names no eye that there is, or no board
/// for it.
bool read_board(const request_t& message, std::optional<Board>& board, std::string& problem) {
  if (message.action != request_t::START) return true;
  if (message.eye == request_t::EYE_SFM) {
    if (!message.board.empty())
      problem = "a board is for eye " + std::to_string(request_t::EYE_PATTERN);
    return message.board.empty();
  }
  if (message.eye != request_t::EYE_PATTERN) {
    problem = "unknown eye " + std::to_string(message.eye);
    return false;
  }
  const auto parsed = parse_board(message.board);
  if (const auto* found = std::get_if<Board>(&parsed)) {
    board = *found;
  } else {
    problem = std::get<std::string>(parsed);
  }
  return board.has_value();
}

}  // namespace

std::optional<Request> read_request(const request_t& message, std::string& problem) {
  std::optional<Board> board;
  const auto action = action_of(message.action);
  if (message.protocol_version != request_t::VERSION) {
    problem = "this daemon speaks protocol version " + std::to_string(request_t::VERSION);
  } else if (!action) {
    problem = "unknown action " + std::to_string(message.action);
  } else if (message.request_id == 0) {
    problem = "request_id must not be 0";
  } else if (!read_board(message, board, problem)) {
    return std::nullopt;
  } else {
    return Request{
        .request_id = message.request_id,
        .action = *action,
        .target_request_id = message.target_request_id,
        .body_id = message.body_id,
        .wanted = {message.wanted_sigma_rotation_deg, message.wanted_sigma_translation_mm},
        .max_duration_s = message.max_duration_s,
        .board = board};
  }
  return std::nullopt;
}

void write_session(const Session& session, status_t& status) {
  status.session_state = state_code(session.state());
  if (const StartOptions* current = session.current()) {
    status.request_id = current->request_id;
    status.max_duration_s = current->max_duration_s;
    status.wanted_sigma_rotation_deg = current->wanted.rotation_deg;
    status.wanted_sigma_translation_mm = current->wanted.translation_mm;
  }
  for (const Ack& ack : session.acks()) {
    if (status.ack_request_id.size() == kAcksInStatus) break;
    status.ack_request_id.push_back(ack.request_id);
    status.ack_code.push_back(ack_code(ack.code));
    status.ack_text.push_back(ack.text);
  }
  status.num_acks = static_cast<std::int32_t>(status.ack_request_id.size());
}

void write_no_progress(status_t& status) {
  status.sigma_rotation_deg = -1;
  status.sigma_translation_mm = -1;
  status.time_offset_sigma_s = -1;
}

void write_progress(const CalibrationProgress& progress, const ProgressTerms& terms,
                    status_t& status) {
  status.elapsed_s = terms.elapsed_s;
  status.progress = overall_progress(progress.provisional, terms);
  status.keyframes = progress.situation.keyframes;
  status.rotation_coverage_deg = progress.situation.rotation_coverage_deg;
  status.translation_coverage_mm = progress.situation.translation_coverage_mm;
  // The enumeration has the wire's numbers, in its order.
  status.guidance_code = static_cast<std::int32_t>(progress.guidance.code);
  status.guidance = progress.guidance.words;
  write_provisional(progress.provisional, status);
}

void write_calibration(const std::optional<ActiveCalibration>& calibration, std::int64_t now_ns,
                       status_t& status) {
  status.calibrated = calibration.has_value();
  status.calibration_age_s = -1;
  if (!calibration) return;
  status.calibration_request_id = calibration->request_id;
  status.calibration_restored = calibration->restored;
  if (calibration->accepted_ns) {
    status.calibration_age_s = 1e-9 * static_cast<double>(now_ns - *calibration->accepted_ns);
  }
}

std::int32_t watch_code(WatchState state) {
  switch (state) {
    case WatchState::kOff:
      return status_t::WATCH_OFF;
    case WatchState::kUnchecked:
      return status_t::WATCH_UNCHECKED;
    case WatchState::kHolds:
      return status_t::WATCH_HOLDS;
    case WatchState::kDoubtful:
      return status_t::WATCH_DOUBTFUL;
    case WatchState::kBroken:
      return status_t::WATCH_BROKEN;
  }
  return status_t::WATCH_UNCHECKED;
}

void write_watch(const WatchStatus& watch, status_t& status) {
  status.watch_state = watch_code(watch.state);
  status.watch_text = watch.text;
  status.watch_deviation_deg = watch.deviation_deg;
  status.watch_deviation_sigma_deg = watch.sigma_deg;
  status.watch_age_s = watch.age_s;
}

std::string_view picture_text(ImageCondition condition) {
  switch (condition) {
    case ImageCondition::kGood:
      break;
    case ImageCondition::kDark:
      return "the picture is dark";
    case ImageCondition::kBright:
      return "the picture is burnt out";
    case ImageCondition::kFrozen:
      return "the picture is frozen";
    case ImageCondition::kInterlaced:
      return "interlaced, one field is used";
    case ImageCondition::kBlurred:
      return "the picture is blurred";
    case ImageCondition::kUnusable:
      return "the picture cannot be used";
  }
  return "";
}

}  // namespace handeye
