// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_equations.hpp"

#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// Of what the frames share against where it is held, in standard deviations.
Eigen::Matrix<double, kWatchCommon, 1> held_residual(const WatchUnknowns& at,
                                                     const WatchWeights& weights) {
  Eigen::Matrix<double, kWatchCommon, 1> held;
  held << log_so3(at.hand_from_eye.linear() * at.start.linear().transpose()) /
              weights.hold_rotation_rad,
      (at.hand_from_eye.translation() - at.start.translation()) / weights.hold_translation_mm,
      at.time_offset_correction_s / weights.time_offset_s;
  return held;
}

}  // namespace

double watch_cost(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                  const WatchWeights& weights) {
  double cost = 0;
  for (const WatchTrack& track : at.tracks)
    cost += watch_track_cost(track, at.room_from_eye, weights);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto hand = watch_hand_residual(frames[k], at.room_from_eye[k], at);
    cost += 0.5 * hand.residual.dot(hand.information * hand.residual);
  }
  const Eigen::Matrix<double, kWatchCommon, 1> held = held_residual(at, weights);
  return cost + 0.5 * held.squaredNorm();
}

WatchEquations::WatchEquations(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                               const WatchWeights& weights, double damping,
                               WatchCurvature curvature) {
  const auto size = static_cast<Eigen::Index>(6 * frames.size() + kWatchCommon);
  matrix_.setZero(size, size);
  right_.setZero(size);
  for (const WatchTrack& track : at.tracks) add_track(track, at, weights, curvature);
  add_hands(frames, at);
  add_holds(at, weights);
  matrix_.diagonal() *= 1.0 + damping;
}

void WatchEquations::add_track(const WatchTrack& track, const WatchUnknowns& at,
                               const WatchWeights& weights, WatchCurvature curvature) {
  WatchPointEquations point(track, weights.depth);
  std::vector<std::pair<Eigen::Index, Eigen::Matrix<double, 6, 3>>> across;
  across.reserve(track.sights.size());
  for (const WatchTrack::Sight& sight : track.sights) {
    const auto sighted = watch_sighted(
        track, sight, at.room_from_eye[static_cast<std::size_t>(sight.frame)], weights);
    if (!sighted) continue;
    point.add(*sighted);
    const auto row = static_cast<Eigen::Index>(6 * sight.frame);
    const Eigen::Matrix<double, 6, 2> weighted = sighted->weight * sighted->by_pose.transpose();
    matrix_.block<6, 6>(row, row) += weighted * sighted->by_pose;
    right_.segment<6>(row) -= weighted * sighted->residual;
    across.emplace_back(row, weighted * sighted->by_point);
    if (curvature == WatchCurvature::kNewton) {
      across.back().second.bottomRightCorner<3, 1>() +=
          sighted->weight * sighted->depth_by_shift.transpose() * sighted->residual;
    }
  }
  if (point.stay_within(track, weights.depth)) {
    for (auto& [row, by_point] : across) by_point.col(2).setZero();
  }
  const Eigen::Matrix3d inverse = point.normal.inverse();
  for (std::size_t i = 0; i < across.size(); ++i) {
    const auto& [row, by_point] = across[i];
    const Eigen::Matrix<double, 6, 3> weighted = by_point * inverse;
    right_.segment<6>(row) -= weighted * point.right;
    for (std::size_t j = 0; j <= i; ++j) {
      matrix_.block<6, 6>(row, across[j].first) -= weighted * across[j].second.transpose();
    }
  }
}

/// The images' equations are in where the eyes are: here they become those in the hand's errors and
/// the common unknowns, and the hand's own are added.
void WatchEquations::add_hands(std::span<const WatchFrame> frames, const WatchUnknowns& at) {
  const Eigen::Index eyes = matrix_.rows() - kWatchCommon;
  Eigen::MatrixXd by_common(eyes, kWatchCommon);
  std::vector<WatchHandResidual> hands;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    hands.push_back(watch_hand_residual(frames[k], at.room_from_eye[k], at));
    by_common.middleRows<6>(static_cast<Eigen::Index>(6 * k)) = hands.back().by_common;
  }
  const Eigen::MatrixXd across =
      matrix_.topLeftCorner(eyes, eyes).selfadjointView<Eigen::Lower>() * by_common;
  matrix_.bottomLeftCorner(kWatchCommon, eyes) = across.transpose();
  matrix_.bottomRightCorner<kWatchCommon, kWatchCommon>() = by_common.transpose() * across;
  right_.tail<kWatchCommon>() = by_common.transpose() * right_.head(eyes);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(6 * k);
    matrix_.block<6, 6>(row, row) += hands[k].information;
    right_.segment<6>(row) -= hands[k].information * hands[k].residual;
  }
}

void WatchEquations::add_holds(const WatchUnknowns& at, const WatchWeights& weights) {
  Eigen::Matrix<double, kWatchCommon, 1> sigma;
  sigma.head<3>().setConstant(weights.hold_rotation_rad);
  sigma.segment<3>(3).setConstant(weights.hold_translation_mm);
  sigma(6) = weights.time_offset_s;
  matrix_.diagonal().tail<kWatchCommon>() += sigma.cwiseAbs2().cwiseInverse();
  right_.tail<kWatchCommon>() -= held_residual(at, weights).cwiseQuotient(sigma);
}

std::optional<double> WatchEquations::step(std::span<const WatchFrame> frames,
                                           WatchUnknowns& unknowns) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix_);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd step = factor.solve(right_);
  if (!step.allFinite()) return std::nullopt;
  const Eigen::Matrix<double, kWatchCommon, 1> moved = step.tail<kWatchCommon>();
  WatchUnknowns common{.hand_from_eye = unknowns.hand_from_eye,
                       .time_offset_correction_s = unknowns.time_offset_correction_s + moved(6)};
  common.hand_from_eye.linear() =
      nearest_rotation(exp_so3(moved.head<3>()) * unknowns.hand_from_eye.linear());
  common.hand_from_eye.translation() += moved.segment<3>(3);
  carry_eyes(frames, common, step.head(step.size() - kWatchCommon), unknowns);
  return 0.5 * step.dot(right_);
}

}  // namespace handeye
