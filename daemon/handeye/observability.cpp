// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/observability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/motion_facts.hpp"

namespace handeye {
namespace {

constexpr double kAlong = 0.8;     // cosine from which on a turn is about the weak direction itself
constexpr double kLacking = 0.35;  // of the largest turn: hardly there
constexpr double kEnough_deg = 6;  // rms about an axis

Observability::Direction weakest(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  return {eigen.eigenvectors().col(2), std::sqrt(std::max(0.0, eigen.eigenvalues()[2]))};
}

}  // namespace

Observability observability(const Matrix6d& covariance) {
  Observability result{weakest(covariance.topLeftCorner<3, 3>()),
                       weakest(covariance.bottomRightCorner<3, 3>())};
  result.rotation_deg.sigma = deg_from_rad(result.rotation_deg.sigma);
  return result;
}

MissingMotion missing_turn(std::span<const HandEyeObservation> observations,
                           const Pose& hand_from_eye, const Eigen::Vector3d& weak_axis_in_hand) {
  if (observations.empty()) return MissingMotion::kNone;
  constexpr std::array<MissingMotion, 3> kAbout{
      MissingMotion::kTiltUpAndDown, MissingMotion::kTurnLeftAndRight, MissingMotion::kRoll};
  std::vector<Pose> room_from_hand;
  for (const HandEyeObservation& observation : observations) {
    room_from_hand.push_back(observation.poses.room_from_hand);
  }
  const Eigen::Vector3d turned = turned_deg(room_from_hand, hand_from_eye);
  const Eigen::Vector3d weak_in_eye = hand_from_eye.linear().transpose() * weak_axis_in_hand;
  const double lacking = kLacking * turned.maxCoeff();
  int least = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(weak_in_eye[axis]) > kAlong) continue;
    // Of two that there was next to nothing of, the easier one comes first, whatever the noise.
    const bool as_good = least >= 0 && turned[least] < lacking;
    if (least < 0 || (turned[axis] < turned[least] && !as_good)) least = axis;
  }
  if (turned[least] > kEnough_deg && turned[least] > lacking) {
    // Enough of those; the third shows the other directions.
    Eigen::Index rarest = 0;
    if (turned.minCoeff(&rarest) > lacking) return MissingMotion::kKeepMoving;
    least = static_cast<int>(rarest);
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
    case MissingMotion::kSlideSideways:
      return "slide the scope sideways";
    case MissingMotion::kKeepMoving:
      return "keep moving the scope, in all directions";
    case MissingMotion::kNone:
      break;
  }
  return "";
}

std::string_view word(MissingMotion missing) {
  switch (missing) {
    case MissingMotion::kTiltUpAndDown:
      return "tilt_up_and_down";
    case MissingMotion::kTurnLeftAndRight:
      return "turn_left_and_right";
    case MissingMotion::kRoll:
      return "roll";
    case MissingMotion::kSlideInAndOut:
      return "slide_in_and_out";
    case MissingMotion::kSlideSideways:
      return "slide_sideways";
    case MissingMotion::kKeepMoving:
      return "keep_moving";
    case MissingMotion::kNone:
      break;
  }
  return "";
}

}  // namespace handeye
