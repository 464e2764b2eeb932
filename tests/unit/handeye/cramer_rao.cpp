// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/cramer_rao.hpp"

#include <cmath>

#include <Eigen/Dense>

namespace handeye::synthetic {
namespace {

constexpr double kStep = 1e-5;  // rad, and of log scale
constexpr double kStep_mm = 1e-3;

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Vector13d = Eigen::Matrix<double, 13, 1>;

Pose turned(const Pose& pose, const Eigen::Vector3d& w, const Eigen::Vector3d& dt) {
  Pose result = Pose::Identity();
  result.linear() = exp_so3(w) * pose.linear();
  result.translation() = pose.translation() + dt;
  return result;
}

/// What both devices would measure without noise at one instant.
struct Measured {
  Pose room_from_hand;
  Pose scene_from_eye;  ///< scene units
};

/// Parameters: hand_from_eye, room_from_scene (both 6), log scale; then this instant's hand (6).
Measured measure(const Truth& truth, const Pose& room_from_hand, const Vector13d& step,
                 const Vector6d& hand_step) {
  const Pose hand_from_eye =
      turned(truth.solution.hand_from_eye, step.segment<3>(0), step.segment<3>(3));
  const Pose room_from_scene =
      turned(truth.room_from_scene, step.segment<3>(6), step.segment<3>(9));
  Measured measured;
  measured.room_from_hand = turned(room_from_hand, hand_step.head<3>(), hand_step.tail<3>());
  measured.scene_from_eye = room_from_scene.inverse() * measured.room_from_hand * hand_from_eye;
  measured.scene_from_eye.translation() *= truth.solution.scale_units_per_mm * std::exp(step[12]);
  return measured;
}

/// In standard deviations of the noise, relative to the measurement at the truth.
Vector12d difference(const Measured& measured, const Measured& at_truth, const PoseNoise& noise,
                     double scale_units_per_mm) {
  Vector12d result;
  result << log_so3(at_truth.room_from_hand.linear().transpose() *
                    measured.room_from_hand.linear()) /
                noise.hand_rotation_rad,
      (measured.room_from_hand.translation() - at_truth.room_from_hand.translation()) /
          noise.hand_translation_mm,
      log_so3(at_truth.scene_from_eye.linear().transpose() * measured.scene_from_eye.linear()) /
          noise.eye_rotation_rad,
      (measured.scene_from_eye.translation() - at_truth.scene_from_eye.translation()) /
          (scale_units_per_mm * noise.eye_translation_mm);
  return result;
}

double step_of(int parameter) {
  return parameter < 12 && parameter % 6 >= 3 ? kStep_mm : kStep;
}

Matrix6d bound_of_hand_from_eye(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd unit = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd inverse =
      (unit.asDiagonal() * information * unit.asDiagonal())
          .llt()
          .solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  return (unit.asDiagonal() * inverse * unit.asDiagonal()).topLeftCorner<6, 6>();
}

}  // namespace

CramerRaoBound cramer_rao_bound(const Truth& truth, const std::vector<Pose>& room_from_hand,
                                const PoseNoise& noise) {
  const double scale = truth.solution.scale_units_per_mm;
  Eigen::Matrix<double, 13, 13> information = Eigen::Matrix<double, 13, 13>::Zero();
  for (const Pose& hand : room_from_hand) {
    const Measured at_truth = measure(truth, hand, Vector13d::Zero(), Vector6d::Zero());
    const auto derivative = [&](const Vector13d& step, const Vector6d& hand_step, double length) {
      return Vector12d(
          (difference(measure(truth, hand, step, hand_step), at_truth, noise, scale) -
           difference(measure(truth, hand, -step, -hand_step), at_truth, noise, scale)) /
          (2.0 * length));
    };
    Eigen::Matrix<double, 12, 13> shared;
    for (int i = 0; i < 13; ++i) {
      shared.col(i) = derivative(step_of(i) * Vector13d::Unit(i), Vector6d::Zero(), step_of(i));
    }
    Eigen::Matrix<double, 12, 6> own;
    for (int i = 0; i < 6; ++i) {
      own.col(i) = derivative(Vector13d::Zero(), step_of(i) * Vector6d::Unit(i), step_of(i));
    }
    // The true hand pose eliminated.
    const Eigen::Matrix<double, 6, 13> mixed = own.transpose() * shared;
    const Matrix6d of_hand = own.transpose() * own;
    information += shared.transpose() * shared - mixed.transpose() * of_hand.ldlt().solve(mixed);
  }
  return {bound_of_hand_from_eye(information.topLeftCorner<12, 12>()),
          bound_of_hand_from_eye(information)};
}

}  // namespace handeye::synthetic
