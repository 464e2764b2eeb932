// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/watch_motion.hpp"

#include <cmath>

namespace handeye::test {
namespace {

constexpr double kStep_s = 1.0 / 240.0;
const Eigen::Vector3d kTrocar(0.0, 0.0, -120.0);  // in the eye frame

}  // namespace

WatchMotion::WatchMotion(std::vector<MotionKind> kinds, unsigned seed)
    : kinds_(std::move(kinds)), random_(seed) {}

double WatchMotion::uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random_);
}

Eigen::Vector3d WatchMotion::within(double size) {
  const double x = uniform(-size, size);
  const double y = uniform(-size, size);
  return {x, y, uniform(-size, size)};
}

void WatchMotion::begin_kind() {
  kind_ = kinds_[random_() % kinds_.size()];
  kind_until_s_ = time_s_ + uniform(4.0, 15.0);
  target_until_s_ = time_s_;
  stiffness_ = kind_ == MotionKind::kTrembling ? 12.0 : uniform(2.0, 4.0);
  axis_ = within(1.0).normalized();
  aim_turn_ = turn_;
  aim_place_ = place_;
  pivot_ = room_from_eye() * kTrocar;
}

void WatchMotion::choose_target() {
  target_until_s_ = time_s_ + uniform(0.7, 2.0);
  const Eigen::Vector3d turn = within(rad_from_deg(18.0));
  const Eigen::Vector3d place = within(15.0);
  switch (kind_) {
    case MotionKind::kPause:
      break;
    case MotionKind::kFree:
      aim_turn_ = turn;
      aim_place_ = place;
      break;
    case MotionKind::kSmall:
      aim_turn_ = turn / 9.0;
      aim_place_ = place / 7.5;
      break;
    case MotionKind::kTurning:
    case MotionKind::kPivot:
      aim_turn_ = turn;
      break;
    case MotionKind::kSliding:
      aim_place_ = exp_so3(turn_) * Eigen::Vector3d(0, 0, 1.5 * place.z());
      break;
    case MotionKind::kOneAxis:
      aim_turn_ = turn.x() * axis_;
      aim_place_ = place;
      break;
    case MotionKind::kTrembling:
      target_until_s_ = time_s_ + uniform(0.1, 0.4);
      aim_turn_ = turn / 26.0;
      aim_place_ = place / 30.0;
      break;
  }
}

void WatchMotion::move(double step_s) {
  if (time_s_ >= kind_until_s_) begin_kind();
  if (time_s_ >= target_until_s_) choose_target();
  const auto follow = [&](const Eigen::Vector3d& aim, Eigen::Vector3d& at, Eigen::Vector3d& speed) {
    speed += step_s * (stiffness_ * stiffness_ * (aim - at) - 2.0 * stiffness_ * speed);
    at += step_s * speed;
  };
  const Eigen::Vector3d before = place_;
  follow(aim_turn_, turn_, turn_speed_);
  if (kind_ == MotionKind::kPivot) {
    place_ = pivot_ - exp_so3(turn_) * kTrocar;
    place_speed_ = (place_ - before) / step_s;
    aim_place_ = place_;
  } else {
    follow(aim_place_, place_, place_speed_);
  }
  speed_mm_s_ = place_speed_.norm();
  time_s_ += step_s;
}

void WatchMotion::advance(double time_s) {
  while (time_s_ + kStep_s < time_s) move(kStep_s);
  if (time_s > time_s_) move(time_s - time_s_);
}

Pose WatchMotion::room_from_eye() const {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(turn_);
  pose.translation() = place_;
  return pose;
}

}  // namespace handeye::test
