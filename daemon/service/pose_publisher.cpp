// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/pose_publisher.hpp"

#include <algorithm>

#include "daemon/session/pose_message.hpp"

namespace handeye {
namespace {

// Where nothing can be predicted: the tracker's sample after a frame arrives within its period and
// latency; then it is late.
constexpr std::int64_t kPatience_ns = 200'000'000;
constexpr std::size_t kMostPending = 64;
constexpr std::int64_t kAgeNotKnown = -1;

std::int32_t validity_of(LookupStatus status) {
  switch (status) {
    case LookupStatus::kOk:
      return camera_pose_t::VALID;
    case LookupStatus::kHidden:
      return camera_pose_t::TRACKER_HIDDEN;
    case LookupStatus::kGap:
    case LookupStatus::kTooOld:  // its samples begin only after the frame
      return camera_pose_t::TRACKER_GAP;
    case LookupStatus::kTooNew:
      return camera_pose_t::TRACKER_LATE;
    case LookupStatus::kEmpty:
      break;
  }
  return camera_pose_t::TRACKER_SILENT;
}

bool may_still_come(LookupStatus status) {
  return status == LookupStatus::kTooNew || status == LookupStatus::kEmpty;
}

}  // namespace

Matrix6d camera_pose_covariance(const HandEstimate& hand, const ActiveCalibration& calibration) {
  // With left perturbations w: R = Exp(w_hand) R_hand Exp(w_x) R_x, so w = w_hand + R_hand w_x and
  // dt = dt_hand + w_hand x (R_hand t_x) + R_hand dt_x.
  const Eigen::Matrix3d& rotation = hand.room_from_hand.linear();
  Matrix6d by_calibration = Matrix6d::Zero();
  by_calibration.topLeftCorner<3, 3>() = rotation;
  by_calibration.bottomRightCorner<3, 3>() = rotation;
  Matrix6d by_hand = Matrix6d::Identity();
  by_hand.bottomLeftCorner<3, 3>() = -skew(rotation * calibration.hand_from_eye.translation());
  Vector6d hand_velocity;
  hand_velocity << hand.angular_velocity, hand.velocity;
  // A time offset that is wrong by d takes the hand d earlier or later on its way.
  const Vector6d by_time = by_hand * hand_velocity * calibration.time_offset_sigma_s;
  return by_calibration * calibration.covariance * by_calibration.transpose() +
         by_hand * hand.covariance * by_hand.transpose() + by_time * by_time.transpose();
}

PosePublisher::PosePublisher(Bus& bus, const std::string& channel,
                             const PosePublisherOptions& options)
    : options_(options), publisher_(bus, channel), pending_(kMostPending) {}

void PosePublisher::use(const ActiveCalibration& calibration) {
  calibration_ = calibration;
  pending_.clear();
  hand_.clear();
}

void PosePublisher::hear(const WatchWord& word) {
  watch_ = word;
  if (!calibration_ || calibration_->request_id != word.request_id) return;
  // Seen to hold, it is as good as one of today.
  if (word.state == status_t::WATCH_HOLDS) calibration_->restored = false;
}

void PosePublisher::add_frame(const FrameStamp& stamp) {
  if (!calibration_) return;
  pending_.push_back(stamp);  // full: overwrites the oldest
}

void PosePublisher::publish_ready(std::int64_t now_ns) {
  while (!pending_.empty() && publish_one(pending_.front(), now_ns)) pending_.pop_front();
}

std::optional<std::int64_t> PosePublisher::due_ns(std::int64_t now_ns) const {
  if (pending_.empty()) return std::nullopt;
  const FrameStamp& next = pending_.front();
  const std::int64_t waited_ns = next.arrival_ns + options_.wait_ns;
  if (options_.predict_ns > 0 && now_ns < waited_ns) return waited_ns;
  return next.timestamp_ns + kPatience_ns;
}

bool PosePublisher::publish_one(const FrameStamp& stamp, std::int64_t now_ns) {
  const std::int64_t hand_ns = stamp.timestamp_ns - calibration_->time_offset_ns;
  const HandLookup found = hand_.lookup(hand_ns);
  std::optional<HandEstimate> hand;
  if (found.status == LookupStatus::kOk) {
    hand = interpolated_hand(found, calibration_->hand_noise);
  } else if (may_still_come(found.status)) {
    hand = predict(stamp, hand_ns, now_ns);
    if (!hand && now_ns - stamp.timestamp_ns < kPatience_ns) return false;
  }
  begin_message(stamp, now_ns);
  message_.validity = hand ? camera_pose_t::VALID : validity_of(found.status);
  if (hand) write(*hand);
  publisher_.publish(message_);
  return true;
}

/// Nothing as long as the frame should wait, and where the tracker's last word is too old.
std::optional<HandEstimate> PosePublisher::predict(const FrameStamp& stamp, std::int64_t hand_ns,
                                                   std::int64_t now_ns) const {
  if (options_.predict_ns == 0 || hand_.size() == 0) return std::nullopt;
  if (now_ns - stamp.arrival_ns < options_.wait_ns) return std::nullopt;
  const std::int64_t ahead_ns = hand_ns - hand_.at(hand_.size() - 1).timestamp_ns;
  if (ahead_ns > options_.predict_ns) return std::nullopt;
  return predict_hand(hand_, hand_ns, calibration_->hand_noise);
}

void PosePublisher::begin_message(const FrameStamp& stamp, std::int64_t now_ns) {
  message_ = camera_pose_t{};
  message_.timestamp_ns = stamp.timestamp_ns;
  message_.frame_seq = stamp.sequence;
  message_.flags = calibration_flags();
  message_.calibration_request_id = calibration_->request_id;
  message_.calibration_age_s = kAgeNotKnown;
  if (const auto& accepted_ns = calibration_->accepted_ns) {
    message_.calibration_age_s = (now_ns - *accepted_ns) / 1'000'000'000;
  }
}

void PosePublisher::write(const HandEstimate& hand) {
  write_pose(hand.room_from_hand * calibration_->hand_from_eye, message_.q_wxyz, message_.t_mm);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> covariance(message_.covariance);
  covariance = camera_pose_covariance(hand, *calibration_);
  if (hand.predicted_s > 0) message_.flags |= camera_pose_t::FLAG_PREDICTED;
  message_.predicted_s = hand.predicted_s;
}

std::int32_t PosePublisher::calibration_flags() const {
  const std::int32_t restored = calibration_->restored ? camera_pose_t::FLAG_RESTORED : 0;
  if (watch_.request_id != calibration_->request_id) return restored;
  if (watch_.state == status_t::WATCH_DOUBTFUL) {
    return restored | camera_pose_t::FLAG_CALIBRATION_DOUBTFUL;
  }
  if (watch_.state == status_t::WATCH_BROKEN) {
    return restored | camera_pose_t::FLAG_CALIBRATION_BROKEN;
  }
  return restored;
}

}  // namespace handeye
