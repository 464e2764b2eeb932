// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/hand_term.hpp"

#include <Eigen/Dense>

namespace handeye {
namespace {

/// Where a part went since the start.
struct Similarity {
  Eigen::Matrix3d rotation{Eigen::Matrix3d::Identity()};
  double scale{1};
  Eigen::Vector3d from{Eigen::Vector3d::Zero()};  ///< mean of the eyes at the start
  Eigen::Vector3d to{Eigen::Vector3d::Zero()};    ///< and now

  Pose moved(const Pose& room_from_eye) const {
    Pose result = Pose::Identity();
    result.linear() = rotation * room_from_eye.linear();
    result.translation() = to + scale * (rotation * (room_from_eye.translation() - from));
    return result;
  }
};

Similarity similarity_of(const MetricScene& scene, const MetricState& state, std::size_t part) {
  const std::vector<std::size_t>& keyframes = scene.keyframes_of_parts[part];
  const auto n = static_cast<double>(keyframes.size());
  Similarity result;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  for (const std::size_t k : keyframes) {
    result.from += scene.keyframes_at_start[k].translation() / n;
    result.to += state.room_from_eye[k].translation() / n;
    turn += state.room_from_eye[k].linear() * scene.keyframes_at_start[k].linear().transpose();
  }
  result.rotation = nearest_rotation(turn);
  double product = 0;
  double square = 0;
  for (const std::size_t k : keyframes) {
    const Eigen::Vector3d before =
        result.rotation * (scene.keyframes_at_start[k].translation() - result.from);
    product += before.dot(state.room_from_eye[k].translation() - result.to);
    square += before.squaredNorm();
  }
  if (product > 0 && square > 0) result.scale = product / square;
  return result;
}

/// (w, dC) from one pose to another.
Vector6d step_between(const Pose& from, const Pose& to) {
  Vector6d step;
  step << log_so3(to.linear() * from.linear().transpose()), to.translation() - from.translation();
  return step;
}

}  // namespace

Vector6d hand_residual(const HandAtFrame& hand, const Pose& room_from_eye,
                       const MetricState& state) {
  // A larger offset means that the hand was measured earlier: step back along its motion.
  const double earlier_s = state.time_offset_s;
  const Eigen::Matrix3d measured =
      hand.room_from_hand.linear() * exp_so3(-earlier_s * hand.angular_velocity);
  const Eigen::Matrix3d implied = room_from_eye.linear() * state.hand_from_eye.linear().transpose();
  Vector6d residual;
  residual << log_so3(implied * measured.transpose()),
      room_from_eye.translation() - implied * state.hand_from_eye.translation() -
          (hand.room_from_hand.translation() - earlier_s * hand.velocity);
  return residual;
}

HandDerivatives hand_derivatives(const HandAtFrame& hand, const Pose& room_from_eye,
                                 const MetricState& state) {
  const Eigen::Matrix3d implied = room_from_eye.linear() * state.hand_from_eye.linear().transpose();
  const Eigen::Vector3d& lever_arm = state.hand_from_eye.translation();
  HandDerivatives result;
  result.by_eye.setIdentity();
  result.by_eye.bottomLeftCorner<3, 3>() = skew(implied * lever_arm);
  result.by_hand_from_eye.setZero();
  result.by_hand_from_eye.topLeftCorner<3, 3>() = -implied;
  result.by_hand_from_eye.bottomLeftCorner<3, 3>() = -implied * skew(lever_arm);
  result.by_hand_from_eye.bottomRightCorner<3, 3>() = -implied;
  result.by_time << hand.room_from_hand.linear() * hand.angular_velocity, hand.velocity;
  return result;
}

std::vector<double> scales_since_start(const MetricScene& scene, const MetricState& state) {
  std::vector<double> scales;
  for (std::size_t part = 0; part < scene.keyframes_of_parts.size(); ++part) {
    scales.push_back(similarity_of(scene, state, part).scale);
  }
  return scales;
}

std::vector<Pose> eyes_at_start(const MetricScene& scene) {
  std::vector<Pose> eyes;
  eyes.reserve(scene.frames.size());
  for (const MetricFrame& frame : scene.frames) eyes.push_back(frame.room_from_eye_start);
  return eyes;
}

std::vector<Pose> eyes_of_frames(const MetricScene& scene, const MetricState& state,
                                 const std::vector<Pose>& sighted_at_start,
                                 const std::vector<Pose>& sighted) {
  std::vector<Similarity> moved_parts;
  for (std::size_t part = 0; part < scene.keyframes_of_parts.size(); ++part) {
    moved_parts.push_back(similarity_of(scene, state, part));
  }
  std::vector<Pose> eyes;
  eyes.reserve(scene.frames.size());
  for (const MetricFrame& frame : scene.frames) {
    if (frame.keyframe) {
      eyes.push_back(state.room_from_eye[frame.before]);
      continue;
    }
    const Similarity& part = moved_parts[frame.part];
    const auto left_over = [&](std::size_t keyframe) {
      return step_between(part.moved(sighted_at_start[keyframe]), sighted[keyframe]);
    };
    const Vector6d step =
        (1.0 - frame.share) * left_over(frame.before) + frame.share * left_over(frame.after);
    Pose eye = part.moved(frame.room_from_eye_start);
    eye.linear() = exp_so3(step.head<3>()) * eye.linear();
    eye.translation() += step.tail<3>();
    eyes.push_back(eye);
  }
  return eyes;
}

}  // namespace handeye
