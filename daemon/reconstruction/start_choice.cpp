// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_choice.hpp"

#include <algorithm>

#include "daemon/geometry/median.hpp"

namespace handeye {
namespace {

constexpr double kClearMargin = 1.2;
constexpr double kSameRotationRad = 0.02;
constexpr double kSameCentre = 0.25;
constexpr int kFewestCommon = 3;  // keyframes: one has no motion, two no path

/// Median depth of the points in the first keyframe.
double median_depth(const Scene& scene) {
  std::vector<double> depths;
  for (const Track& track : scene.tracks) {
    if (track.has_point) {
      depths.push_back((scene.keyframes.front().eye_from_scene * track.point_scene).z());
    }
  }
  return median(std::move(depths));
}

/// A keyframe as the first sees it, in units of the median depth.
Pose seen_from_first(const Scene& scene, const Keyframe& keyframe, double depth) {
  Pose pose = keyframe.eye_from_scene * scene.keyframes.front().eye_from_scene.inverse();
  pose.translation() /= depth;
  return pose;
}

}  // namespace

bool same_solution(const Scene& a, const Scene& b) {
  const double depth_a = median_depth(a);
  const double depth_b = median_depth(b);
  if (!(depth_a > 0) || !(depth_b > 0)) return false;
  int common = 0;
  double extent = 0.0;
  double difference = 0.0;
  for (const Keyframe& of_a : a.keyframes) {
    const auto of_b = std::find_if(b.keyframes.begin(), b.keyframes.end(), [&](const auto& other) {
      return other.frame_index == of_a.frame_index;
    });
    if (of_b == b.keyframes.end()) continue;
    ++common;
    const Pose pose_a = seen_from_first(a, of_a, depth_a);
    const Pose pose_b = seen_from_first(b, *of_b, depth_b);
    if (rotation_angle_rad(pose_a.linear(), pose_b.linear()) > kSameRotationRad) return false;
    const Eigen::Vector3d centre_a = pose_a.inverse().translation();
    const Eigen::Vector3d centre_b = pose_b.inverse().translation();
    extent = std::max({extent, centre_a.norm(), centre_b.norm()});
    difference = std::max(difference, (centre_a - centre_b).norm());
  }
  return common >= kFewestCommon && difference <= kSameCentre * extent;
}

std::optional<std::size_t> choose_start(const std::vector<StartCandidate>& candidates) {
  if (candidates.empty()) return std::nullopt;
  const auto best =
      std::min_element(candidates.begin(), candidates.end(),
                       [](const auto& a, const auto& b) { return a.error_px < b.error_px; });
  for (const StartCandidate& other : candidates) {
    const bool near = other.error_px < kClearMargin * best->error_px;
    if (near && !same_solution(best->scene, other.scene)) return std::nullopt;
  }
  return static_cast<std::size_t>(best - candidates.begin());
}

}  // namespace handeye
