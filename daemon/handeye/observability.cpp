// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/observability.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr double kAlong = 0.8;  // cosine from which on a turn is about the weak direction itself

Observability::Direction weakest(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  return {eigen.eigenvectors().col(2), std::sqrt(std::max(0.0, eigen.eigenvalues()[2]))};
}

/// Mean square turn about the camera's axes, against the mean attitude.
Eigen::Vector3d turns_in_eye(std::span<const HandEyeObservation> observations,
                             const Eigen::Matrix3d& hand_from_eye) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const HandEyeObservation& observation : observations) {
    sum += observation.poses.room_from_hand.linear();
  }
  const Eigen::Matrix3d mean_attitude = nearest_rotation(sum);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const HandEyeObservation& observation : observations) {
    const Eigen::Vector3d in_hand =
        log_so3(mean_attitude.transpose() * observation.poses.room_from_hand.linear());
    squares += (hand_from_eye.transpose() * in_hand).cwiseAbs2();
  }
  return squares / static_cast<double>(observations.size());
}

}  // namespace

Observability observability(const Matrix6d& covariance) {
  Observability result{weakest(covariance.topLeftCorner<3, 3>()),
                       weakest(covariance.bottomRightCorner<3, 3>())};
  result.rotation_deg.sigma = deg_from_rad(result.rotation_deg.sigma);
  return result;
}

MissingMotion missing_motion(std::span<const HandEyeObservation> observations,
                             const Pose& hand_from_eye, const Observability& weakest,
                             bool scale_to_blame) {
  if (scale_to_blame) return MissingMotion::kSlideInAndOut;
  if (observations.empty()) return MissingMotion::kNone;
  constexpr std::array<MissingMotion, 3> kAbout{
      MissingMotion::kTiltUpAndDown, MissingMotion::kTurnLeftAndRight, MissingMotion::kRoll};
  const Eigen::Vector3d turns = turns_in_eye(observations, hand_from_eye.linear());
  const Eigen::Vector3d weak_in_eye =
      hand_from_eye.linear().transpose() * weakest.rotation_deg.axis_in_hand;
  int least = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(weak_in_eye[axis]) > kAlong) continue;
    if (least < 0 || turns[axis] < turns[least]) least = axis;
  }
  return kAbout[static_cast<std::size_t>(least)];
}

std::string_view words(MissingMotion missing) {
  switch (missing) {
    case MissingMotion::kTiltUpAndDown:
      return "tilt the scope up and down";
    case MissingMotion::kTurnLeftAndRight:
      return "turn the scope left and right";
    case MissingMotion::kRoll:
      return "roll the scope about its axis";
    case MissingMotion::kSlideInAndOut:
      return "slide the scope in and out";
    case MissingMotion::kNone:
      break;
  }
  return "";
}

}  // namespace handeye
