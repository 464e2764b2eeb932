// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_equations.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr int kSettlings = 3;
/// A point that lies behind an eye counts as an outlier of this many bends of the loss.
constexpr double kBehind = 30.0;

/// Of a point before an eye, in units of its distance from the anchor.
constexpr double kNearest = 0.05;

using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// The point as seen from the eye, up to its depth in the anchor's frame.
Eigen::Vector3d towards(const WatchTrack& track, const Pose& room_from_eye) {
  const Eigen::Vector3d bearing(track.point.x(), track.point.y(), 1.0);
  return room_from_eye.linear().transpose() *
         (track.room_from_anchor.linear() * bearing +
          track.point.z() * (track.room_from_anchor.translation() - room_from_eye.translation()));
}

double cauchy_cost(double squared) {
  return std::log1p(squared);
}

double inverse_depth_residual(const WatchTrack& track) {
  return (track.point.z() - kUsualInverseDepth) / kInverseDepthSigma;
}

/// What the images say about one feature, in units of half a squared standard deviation.
double track_cost(const WatchTrack& track, const std::vector<Pose>& room_from_eye,
                  const WatchWeights& weights) {
  const double bend = weights.robust_image / weights.image;
  double cost = 0.5 * std::pow(inverse_depth_residual(track), 2);
  for (const WatchTrack::Sight& sight : track.sights) {
    const auto seen = watch_ray(track, room_from_eye[static_cast<std::size_t>(sight.frame)]);
    const double bends = seen ? (*seen - sight.ray).norm() / weights.robust_image : kBehind;
    cost += 0.5 * bend * bend * cauchy_cost(bends * bends);
  }
  return cost;
}

/// One sight of a point, to first order.
struct Sighted {
  Eigen::Vector2d residual{Eigen::Vector2d::Zero()};
  double weight{0};
  Eigen::Matrix<double, 2, 6> by_pose;  ///< (w [rad], dc [mm]) of room_from_eye
  Matrix23 by_point;
};

/// Nothing where the point is not before the eye.
std::optional<Sighted> linearise(const WatchTrack& track, const Eigen::Vector2d& measured,
                                 const Pose& eye, const WatchWeights& weights) {
  const Eigen::Vector3d seen = towards(track, eye);
  if (!(seen.z() > kNearest)) return std::nullopt;
  Sighted sighted;
  const Eigen::Vector2d ray = seen.hnormalized();
  sighted.residual = ray - measured;
  const double bends2 =
      sighted.residual.squaredNorm() / (weights.robust_image * weights.robust_image);
  sighted.weight = 1.0 / ((1.0 + bends2) * weights.image * weights.image);
  Matrix23 by_seen;
  by_seen << 1.0, 0.0, -ray.x(), 0.0, 1.0, -ray.y();
  const Matrix23 by_room = by_seen / seen.z() * eye.linear().transpose();
  // seen = R^T y with y in the room: R -> Exp(w) R makes it R^T (y - w x y) = R^T (y + [y]x w).
  sighted.by_pose << by_room * skew(eye.linear() * seen), -track.point.z() * by_room;
  const Matrix23 by_bearing = by_room * track.room_from_anchor.linear();
  sighted.by_point << by_bearing.leftCols<2>(),
      by_room * (track.room_from_anchor.translation() - eye.translation());
  return sighted;
}

/// Normal equations of a point alone, before its sights.
struct PointEquations {
  Eigen::Matrix3d normal{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d right{Eigen::Vector3d::Zero()};

  explicit PointEquations(const WatchTrack& track) {
    const double depth_weight = 1.0 / (kInverseDepthSigma * kInverseDepthSigma);
    // The direction is held, ever so lightly: where no eye sees the point it would be free.
    normal.diagonal() << 1.0, 1.0, depth_weight;
    right.z() = -depth_weight * (track.point.z() - kUsualInverseDepth);
  }
  void add(const Sighted& sighted) {
    normal += sighted.weight * sighted.by_point.transpose() * sighted.by_point;
    right -= sighted.weight * sighted.by_point.transpose() * sighted.residual;
  }
};

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

std::optional<Eigen::Vector2d> watch_ray(const WatchTrack& track, const Pose& room_from_eye) {
  const Eigen::Vector3d seen = towards(track, room_from_eye);
  if (!(seen.z() > kNearest)) return std::nullopt;
  return seen.hnormalized();
}

double watch_cost(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                  const WatchWeights& weights) {
  double cost = 0;
  for (const WatchTrack& track : at.tracks) cost += track_cost(track, at.room_from_eye, weights);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto hand = watch_hand_residual(frames[k], at.room_from_eye[k], at);
    cost += 0.5 * hand.residual.dot(hand.information * hand.residual);
  }
  const Eigen::Matrix<double, kWatchCommon, 1> held = held_residual(at, weights);
  return cost + 0.5 * held.squaredNorm();
}

WatchEquations::WatchEquations(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                               const WatchWeights& weights, double damping) {
  const auto size = static_cast<Eigen::Index>(6 * frames.size() + kWatchCommon);
  matrix_.setZero(size, size);
  right_.setZero(size);
  for (const WatchTrack& track : at.tracks) add_track(track, at, weights);
  add_hands(frames, at);
  add_holds(at, weights);
  matrix_.diagonal() *= 1.0 + damping;
}

void WatchEquations::add_track(const WatchTrack& track, const WatchUnknowns& at,
                               const WatchWeights& weights) {
  PointEquations point(track);
  std::vector<std::pair<Eigen::Index, Eigen::Matrix<double, 6, 3>>> across;
  across.reserve(track.sights.size());
  for (const WatchTrack::Sight& sight : track.sights) {
    const auto sighted = linearise(
        track, sight.ray, at.room_from_eye[static_cast<std::size_t>(sight.frame)], weights);
    if (!sighted) continue;
    point.add(*sighted);
    const auto row = static_cast<Eigen::Index>(6 * sight.frame);
    const Eigen::Matrix<double, 6, 2> weighted = sighted->weight * sighted->by_pose.transpose();
    matrix_.block<6, 6>(row, row) += weighted * sighted->by_pose;
    right_.segment<6>(row) -= weighted * sighted->residual;
    across.emplace_back(row, weighted * sighted->by_point);
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

void settle_points(const WatchWeights& weights, WatchUnknowns& unknowns) {
  for (WatchTrack& track : unknowns.tracks) {
    double cost = track_cost(track, unknowns.room_from_eye, weights);
    for (int settling = 0; settling < kSettlings; ++settling) {
      PointEquations point(track);
      for (const WatchTrack::Sight& sight : track.sights) {
        const Pose& eye = unknowns.room_from_eye[static_cast<std::size_t>(sight.frame)];
        if (const auto sighted = linearise(track, sight.ray, eye, weights)) point.add(*sighted);
      }
      WatchTrack next = track;
      next.point += point.normal.inverse() * point.right;
      next.point.z() = std::clamp(next.point.z(), kLeastInverseDepth, kLargestInverseDepth);
      const double next_cost = track_cost(next, unknowns.room_from_eye, weights);
      if (!(next_cost < cost)) break;
      track.point = next.point;
      cost = next_cost;
    }
  }
}

}  // namespace handeye
