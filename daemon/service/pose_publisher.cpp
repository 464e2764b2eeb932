// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/pose_publisher.hpp"

#include "daemon/session/pose_message.hpp"

namespace handeye {
namespace {

// The tracker's sample after a frame arrives within its period and latency; then it is late.
constexpr std::int64_t kPatience_ns = 200'000'000;
constexpr std::size_t kMostPending = 64;

std::int32_t validity_of(LookupStatus status) {
  switch (status) {
    case LookupStatus::kOk:
      return camera_pose_t::VALID;
    case LookupStatus::kHidden:
      return camera_pose_t::TRACKER_HIDDEN;
    case LookupStatus::kGap:
      return camera_pose_t::TRACKER_GAP;
    case LookupStatus::kTooNew:
      return camera_pose_t::TRACKER_LATE;
    case LookupStatus::kTooOld:
    case LookupStatus::kEmpty:
      break;
  }
  return camera_pose_t::TRACKER_SILENT;
}

}  // namespace

Matrix6d camera_pose_covariance(const Pose& room_from_hand, const ActiveCalibration& calibration) {
  // With left perturbations w: R = Exp(w_hand) R_hand Exp(w_x) R_x, so w = w_hand + R_hand w_x and
  // dt = dt_hand + w_hand x (R_hand t_x) + R_hand dt_x.
  const Eigen::Matrix3d& rotation = room_from_hand.linear();
  Matrix6d by_calibration = Matrix6d::Zero();
  by_calibration.topLeftCorner<3, 3>() = rotation;
  by_calibration.bottomRightCorner<3, 3>() = rotation;
  Matrix6d by_hand = Matrix6d::Identity();
  by_hand.bottomLeftCorner<3, 3>() = -skew(rotation * calibration.hand_from_eye.translation());
  Vector6d hand_variance;
  const auto square = [](double value) { return value * value; };
  hand_variance.head<3>().setConstant(square(calibration.hand_rotation_sigma_rad));
  hand_variance.tail<3>().setConstant(square(calibration.hand_translation_sigma_mm));
  return by_calibration * calibration.covariance * by_calibration.transpose() +
         by_hand * hand_variance.asDiagonal() * by_hand.transpose();
}

PosePublisher::PosePublisher(Bus& bus, const std::string& channel)
    : publisher_(bus, channel), pending_(kMostPending) {}

void PosePublisher::use(const ActiveCalibration& calibration) {
  calibration_ = calibration;
  pending_.clear();
  hand_.clear();
}

void PosePublisher::add_frame(const FrameStamp& stamp) {
  if (!calibration_) return;
  pending_.push_back(stamp);  // full: overwrites the oldest
}

void PosePublisher::publish_ready(std::int64_t now_ns) {
  while (!pending_.empty() && publish_one(pending_.front(), now_ns)) pending_.pop_front();
}

bool PosePublisher::publish_one(const FrameStamp& stamp, std::int64_t now_ns) {
  const HandLookup hand = hand_.lookup(stamp.timestamp_ns - calibration_->time_offset_ns);
  const bool may_still_come =
      hand.status == LookupStatus::kTooNew || hand.status == LookupStatus::kEmpty;
  if (may_still_come && now_ns - stamp.timestamp_ns < kPatience_ns) return false;

  message_ = camera_pose_t{};
  message_.timestamp_ns = stamp.timestamp_ns;
  message_.frame_seq = stamp.sequence;
  message_.validity = validity_of(hand.status);
  message_.calibration_request_id = calibration_->request_id;
  message_.calibration_age_s = (now_ns - calibration_->accepted_ns) / 1'000'000'000;
  if (hand.status == LookupStatus::kOk) {
    write_pose(hand.room_from_hand * calibration_->hand_from_eye, message_.q_wxyz, message_.t_mm);
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> covariance(message_.covariance);
    covariance = camera_pose_covariance(hand.room_from_hand, *calibration_);
  }
  publisher_.publish(message_);
  return true;
}

}  // namespace handeye
