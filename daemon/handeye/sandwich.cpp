// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/sandwich.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/methods/least_squares.hpp"
#include "daemon/handeye/movements.hpp"
#include "daemon/handeye/sandwich_rows.hpp"
#include "daemon/handeye/sandwich_stages.hpp"
#include "daemon/handeye/translation_weights.hpp"

namespace handeye {
namespace {

using sandwich::kLength;
using sandwich::kScale;
using sandwich::kShape;
using sandwich::kShift;
using sandwich::kTurn;
using sandwich::kUnknowns;
using sandwich::Rows;
using sandwich::Stage;

constexpr double kMinConditioning = 1e-13;  // of a stage's scaled normal equations

// A pose's noise: hand's rotation, hand's translation, eye's rotation, eye's translation.
constexpr int kNoises = 12;

/// Of a pose's noise on the unknowns. Matrices are not of fixed size: unrolled, they take long to
/// compile and gain little.
using Influence = Eigen::MatrixXd;

Influence no_influence() {
  return Influence::Zero(kUnknowns, kNoises);
}

/// A movement's errors (delta, epsilon; see LinearRows) by X's and by its two poses' noise.
struct MovementErrors {
  std::array<std::size_t, 2> pair{};
  Pose hand{Pose::Identity()};
  Eigen::MatrixXd of_unknowns{Eigen::MatrixXd::Zero(6, kShape)};
  Eigen::MatrixXd of_i{Eigen::MatrixXd::Zero(6, kNoises)};
  Eigen::MatrixXd of_j{Eigen::MatrixXd::Zero(6, kNoises)};
};

MovementErrors errors_of(const std::array<std::size_t, 2>& pair, std::span<const PosePair> poses,
                         const Pose& eye_from_hand) {
  const Pose& room_from_hand_j = poses[pair[1]].room_from_hand;
  MovementErrors errors;
  errors.pair = pair;
  errors.hand = room_from_hand_j.inverse() * poses[pair[0]].room_from_hand;
  const Pose eye = eye_from_hand * errors.hand * eye_from_hand.inverse();
  const Eigen::Matrix3d& rotation = eye_from_hand.linear();
  const Eigen::Matrix3d r_hand = errors.hand.linear();
  const Eigen::Matrix3d r_eye = eye.linear();
  const Eigen::Matrix3d hand_j_from_room = room_from_hand_j.linear().transpose();
  const Eigen::Matrix3d still = Eigen::Matrix3d::Identity() - r_eye;
  const Eigen::Vector3d hand_in_eye = rotation * errors.hand.translation();

  errors.of_unknowns.block<3, 3>(0, kTurn) = still;
  errors.of_unknowns.block<3, 3>(3, kTurn) = -skew(hand_in_eye);
  errors.of_unknowns.block<3, 3>(3, kShift) = still;
  errors.of_unknowns.block<3, 1>(3, kScale) = hand_in_eye;

  // Noise turns the hand about its own origin, in its own frame, and shifts it in the room; it
  // turns and shifts the camera in its own frame. To first order that turns a movement, from the
  // left, by a and shifts it by b:
  //   a_H = R_H n_i - n_j,   b_H = skew(t_H) n_j + R_j^T (m_i - m_j),
  //   a_E = n_j - R_E n_i,   b_E = -skew(t_E) n_j + m_j - R_E m_i,
  // and delta = R_X a_H - a_E, epsilon = R_X b_H - b_E + skew(R_E t_X) a_E.
  const Eigen::Matrix3d lever = skew(r_eye * eye_from_hand.translation());
  errors.of_i.block<3, 3>(0, 0) = rotation * r_hand;
  errors.of_i.block<3, 3>(3, 3) = rotation * hand_j_from_room;
  errors.of_i.block<3, 3>(0, 6) = r_eye;
  errors.of_i.block<3, 3>(3, 6) = -lever * r_eye;
  errors.of_i.block<3, 3>(3, 9) = r_eye;
  errors.of_j.block<3, 3>(0, 0) = -rotation;
  errors.of_j.block<3, 3>(3, 0) = rotation * skew(errors.hand.translation());
  errors.of_j.block<3, 3>(3, 3) = -rotation * hand_j_from_room;
  errors.of_j.block<3, 3>(0, 6) = -Eigen::Matrix3d::Identity();
  errors.of_j.block<3, 3>(3, 6) = lever + skew(eye.translation());
  errors.of_j.block<3, 3>(3, 9) = -Eigen::Matrix3d::Identity();
  return errors;
}

struct Units {
  double normalised_mm{1};      ///< in which the linear methods give translations
  std::vector<double> weights;  ///< of the movements' translations
};

/// Solves a stage: replaces its unknowns' rows in every pose's influence. False when singular.
bool solve_stage(const Stage& stage, const std::vector<MovementErrors>& movements,
                 const Pose& eye_from_hand, const Units& units, std::vector<Influence>& influence) {
  const bool in_mm =
      stage.rows == Rows::kQuaternionsTranslation || stage.rows == Rows::kSimilarityQuaternions;
  const double unit_mm = in_mm ? 1.0 : units.normalised_mm;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
  std::vector<Influence> gathered(influence.size(), no_influence());
  for (std::size_t k = 0; k < movements.size(); ++k) {
    const MovementErrors& movement = movements[k];
    auto [of_error, of_shape] =
        sandwich::linear_rows(stage.rows, movement.hand, eye_from_hand, unit_mm);
    if (stage.weighted) {
      of_error.bottomRows(3) *= units.weights[k];
      of_shape.bottomRows(3) *= units.weights[k];
    }
    Eigen::MatrixXd jacobian(of_error.rows(), kUnknowns);
    jacobian << of_error * movement.of_unknowns, of_shape,
        of_error * movement.of_unknowns.col(kScale);
    normal.noalias() += jacobian.transpose() * jacobian;
    const Eigen::MatrixXd to_unknowns = jacobian.transpose() * of_error;
    gathered[movement.pair[0]].noalias() += to_unknowns * movement.of_i;
    gathered[movement.pair[1]].noalias() += to_unknowns * movement.of_j;
  }

  normal(kLength, kLength) += kConstraintWeight;

  const std::vector<Eigen::Index> own = sandwich::unknowns_of(stage);
  const Eigen::MatrixXd own_normal = normal(own, own);
  const Eigen::VectorXd lengths = own_normal.diagonal().cwiseSqrt();
  if (!(lengths.minCoeff() > 0) || !lengths.allFinite()) return false;
  const Eigen::MatrixXd scaled = own_normal.cwiseQuotient(lengths * lengths.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  if (!(eigen.eigenvalues().minCoeff() > kMinConditioning)) return false;
  const Eigen::MatrixXd inverse =
      (eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
       eigen.eigenvectors().transpose())
          .cwiseQuotient(lengths * lengths.transpose());

  Eigen::MatrixXd of_others = normal(own, Eigen::all);  // of what the stages before have found
  for (const Eigen::Index k : own) of_others.col(k).setZero();
  for (std::size_t i = 0; i < influence.size(); ++i) {
    const Eigen::MatrixXd own_gathered = gathered[i](own, Eigen::all);
    influence[i](own, Eigen::all) = -inverse * (own_gathered + of_others * influence[i]);
  }
  return true;
}

/// From X's errors to those of (w, dt) of hand_from_eye, whose translation is in mm of the true
/// scale.
Eigen::MatrixXd to_hand_from_eye(const Pose& eye_from_hand) {
  const Eigen::Matrix3d transposed = eye_from_hand.linear().transpose();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6, kUnknowns);
  matrix.block<3, 3>(0, kTurn) = -transposed;
  matrix.block<3, 3>(3, kTurn) = -transposed * skew(eye_from_hand.translation());
  matrix.block<3, 3>(3, kShift) = -transposed;
  matrix.block<3, 1>(3, kScale) = transposed * eye_from_hand.translation();
  return matrix;
}

Eigen::VectorXd deviations(const PoseNoise& noise) {
  Eigen::VectorXd sigma(kNoises);
  sigma << Eigen::Vector3d::Constant(noise.hand_rotation_rad),
      Eigen::Vector3d::Constant(noise.hand_translation_mm),
      Eigen::Vector3d::Constant(noise.eye_rotation_rad),
      Eigen::Vector3d::Constant(noise.eye_translation_mm);
  return sigma;
}

std::optional<Units> units_of(std::span<const PosePair> poses,
                              std::span<const std::array<std::size_t, 2>> pairs,
                              const HandEyeSolution& solution, ScaleMode scale) {
  std::vector<Movement> movements;
  movements.reserve(pairs.size());
  for (const auto& [i, j] : pairs) movements.push_back(movement_between(poses[i], poses[j]));
  auto normalised = normalise(movements, scale);
  if (!normalised) return std::nullopt;
  const double eye_unit = normalised->hand_mm * solution.scale_units_per_mm / normalised->eye_units;
  for (Movement& movement : normalised->movements) {
    movement.eye_j_from_eye_i.translation() /= eye_unit;
  }
  Pose eye_from_hand = solution.hand_from_eye.inverse();
  eye_from_hand.translation() /= normalised->hand_mm;
  return Units{normalised->hand_mm, translation_weights(normalised->movements, eye_from_hand)};
}

}  // namespace

std::optional<Matrix6d> sandwich_covariance(const Method& method, std::span<const PosePair> poses,
                                            std::span<const std::array<std::size_t, 2>> pairs,
                                            const HandEyeSolution& solution,
                                            const PoseNoise& noise) {
  const std::vector<Stage> all_stages = sandwich::stages(method.error_model);
  if (all_stages.empty()) return std::nullopt;
  const bool free_scale =
      std::any_of(all_stages.begin(), all_stages.end(), [](const Stage& s) { return s.scale; });
  const auto units =
      units_of(poses, pairs, solution, free_scale ? ScaleMode::kUnknown : ScaleMode::kKnown);
  if (!units) return std::nullopt;

  const Pose eye_from_hand = solution.hand_from_eye.inverse();
  std::vector<MovementErrors> movements;
  movements.reserve(pairs.size());
  for (const auto& pair : pairs) movements.push_back(errors_of(pair, poses, eye_from_hand));
  std::vector<Influence> influence(poses.size(), no_influence());
  for (const Stage& stage : all_stages) {
    if (!solve_stage(stage, movements, eye_from_hand, *units, influence)) return std::nullopt;
  }

  const Eigen::MatrixXd output = to_hand_from_eye(eye_from_hand);
  const Eigen::VectorXd sigma = deviations(noise);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(6, 6);
  for (const Influence& of_pose : influence) {
    const Eigen::MatrixXd passed = output * of_pose * sigma.asDiagonal();
    covariance.noalias() += passed * passed.transpose();
  }
  if (!covariance.allFinite()) return std::nullopt;
  return Matrix6d(covariance);
}

}  // namespace handeye
