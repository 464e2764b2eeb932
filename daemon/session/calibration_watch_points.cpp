// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_points.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr int kSettlings = 8;
/// A fall of a point's cost that is none: of all points together still far below one deviation.
constexpr double kSettled = 1e-4;
constexpr double kFirstDamping = 0.1;
/// A point that lies behind an eye counts as an outlier of this many bends of the loss.
constexpr double kBehind = 30.0;
constexpr double kBehindSigmas = 120.0;  ///< likewise without a loss

/// Of a point before an eye, in units of its distance from the anchor.
constexpr double kNearest = 0.05;

/// The point as seen from the eye, up to its depth in the anchor's frame.
Eigen::Vector3d towards(const WatchTrack& track, const Pose& room_from_eye) {
  const Eigen::Vector3d bearing(track.point.x(), track.point.y(), 1.0);
  return room_from_eye.linear().transpose() *
         (track.room_from_anchor.linear() * bearing +
          track.point.z() * (track.room_from_anchor.translation() - room_from_eye.translation()));
}

/// Of a residual's length.
double sight_cost(std::optional<double> off, const WatchWeights& weights) {
  if (weights.robust_image <= 0) {
    const double sigmas = off ? *off / weights.image : kBehindSigmas;
    return 0.5 * sigmas * sigmas;
  }
  const double bend = weights.robust_image / weights.image;
  const double bends = off ? *off / weights.robust_image : kBehind;
  return 0.5 * bend * bend * std::log1p(bends * bends);
}

double belief(double off, const WatchWeights& weights) {
  if (weights.robust_image <= 0) return 1.0;
  const double bends = off / weights.robust_image;
  return 1.0 / (1.0 + bends * bends);
}

}  // namespace

std::optional<Eigen::Vector2d> watch_ray(const WatchTrack& track, const Pose& room_from_eye) {
  const Eigen::Vector3d seen = towards(track, room_from_eye);
  if (!(seen.z() > kNearest)) return std::nullopt;
  return seen.hnormalized();
}

double watch_track_cost(const WatchTrack& track, const std::vector<Pose>& room_from_eye,
                        const WatchWeights& weights) {
  double cost = 0.5 * std::pow((track.point.z() - weights.depth.usual) / weights.depth.sigma, 2);
  for (const WatchTrack::Sight& sight : track.sights) {
    const auto seen = watch_ray(track, room_from_eye[static_cast<std::size_t>(sight.frame)]);
    const auto off = seen ? std::optional((*seen - sight.ray).norm()) : std::nullopt;
    cost += sight.trust * sight_cost(off, weights);
  }
  return cost;
}

std::optional<WatchSighted> watch_sighted(const WatchTrack& track, const WatchTrack::Sight& sight,
                                          const Pose& eye, const WatchWeights& weights) {
  const Eigen::Vector3d seen = towards(track, eye);
  if (!(seen.z() > kNearest)) return std::nullopt;
  WatchSighted sighted;
  const Eigen::Vector2d ray = seen.hnormalized();
  sighted.residual = ray - sight.ray;
  sighted.weight =
      sight.trust * belief(sighted.residual.norm(), weights) / (weights.image * weights.image);
  Eigen::Matrix<double, 2, 3> by_seen;
  by_seen << 1.0, 0.0, -ray.x(), 0.0, 1.0, -ray.y();
  const Eigen::Matrix<double, 2, 3> by_room = by_seen / seen.z() * eye.linear().transpose();
  // seen = R^T y with y in the room: R -> Exp(w) R makes it R^T (y - w x y) = R^T (y + [y]x w).
  sighted.by_pose << by_room * skew(eye.linear() * seen), -track.point.z() * by_room;
  sighted.depth_by_shift = -by_room;
  const Eigen::Matrix<double, 2, 3> by_bearing = by_room * track.room_from_anchor.linear();
  sighted.by_point << by_bearing.leftCols<2>(),
      by_room * (track.room_from_anchor.translation() - eye.translation());
  return sighted;
}

WatchPointEquations::WatchPointEquations(const WatchTrack& track, const WatchDepth& depth) {
  const double depth_weight = 1.0 / (depth.sigma * depth.sigma);
  // The direction is held, ever so lightly: where no eye sees the point it would be free.
  normal.diagonal() << 1.0, 1.0, depth_weight;
  right.z() = -depth_weight * (track.point.z() - depth.usual);
}

void WatchPointEquations::add(const WatchSighted& sighted) {
  normal += sighted.weight * sighted.by_point.transpose() * sighted.by_point;
  right -= sighted.weight * sighted.by_point.transpose() * sighted.residual;
}

bool WatchPointEquations::stay_within(const WatchTrack& track, const WatchDepth& depth) {
  const bool far = track.point.z() <= depth.least && right.z() < 0;
  const bool near = track.point.z() >= depth.largest && right.z() > 0;
  if (!far && !near) return false;
  normal.col(2).setZero();
  normal.row(2).setZero();
  normal(2, 2) = 1.0;
  right.z() = 0;
  return true;
}

void settle_points(const WatchWeights& weights, WatchUnknowns& unknowns) {
  const WatchDepth& depth = weights.depth;
  for (WatchTrack& track : unknowns.tracks) {
    track.point.z() = std::clamp(track.point.z(), depth.least, depth.largest);
    double cost = watch_track_cost(track, unknowns.room_from_eye, weights);
    double damping = 0;
    for (int settling = 0; settling < kSettlings; ++settling) {
      WatchPointEquations point(track, depth);
      for (const WatchTrack::Sight& sight : track.sights) {
        const Pose& eye = unknowns.room_from_eye[static_cast<std::size_t>(sight.frame)];
        if (const auto sighted = watch_sighted(track, sight, eye, weights)) point.add(*sighted);
      }
      point.stay_within(track, depth);
      point.normal.diagonal() *= 1.0 + damping;
      WatchTrack next = track;
      next.point += point.normal.inverse() * point.right;
      next.point.z() = std::clamp(next.point.z(), depth.least, depth.largest);
      const double fall = cost - watch_track_cost(next, unknowns.room_from_eye, weights);
      if (fall > 0) {
        track.point = next.point;
        cost -= fall;
      }
      if (std::abs(fall) < kSettled) break;
      damping = fall > 0 ? 0.1 * damping : std::max(kFirstDamping, 10.0 * damping);
    }
  }
}

void freeze_trust(const WatchWeights& weights, WatchUnknowns& unknowns) {
  for (WatchTrack& track : unknowns.tracks) {
    for (WatchTrack::Sight& sight : track.sights) {
      const Pose& eye = unknowns.room_from_eye[static_cast<std::size_t>(sight.frame)];
      const auto seen = watch_ray(track, eye);
      const double off = seen ? (*seen - sight.ray).norm() : kBehind * weights.robust_image;
      sight.trust = belief(off, weights);
    }
  }
}

}  // namespace handeye
