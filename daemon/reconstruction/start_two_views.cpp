// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_two_views.hpp"

#include <array>

#include "daemon/reconstruction/resection.hpp"
#include "daemon/reconstruction/triangulation.hpp"

namespace handeye {
namespace {

/// Points that the two views fix, as far as they are in front of both.
std::vector<std::optional<Eigen::Vector3d>> triangulate_pair(const StartWindow& window,
                                                             Eigen::Index other,
                                                             const Pose& other_from_first,
                                                             double min_angle_rad) {
  const Pose first = Pose::Identity();
  std::vector<std::optional<Eigen::Vector3d>> points;
  for (const RayPair& pair : window.pairs_with_first(other)) {
    const std::array<PosedRay, 2> rays{{{&first, pair.first}, {&other_from_first, pair.second}}};
    auto point = triangulate(rays);
    if (point && triangulation_angle_rad(rays, *point) < min_angle_rad) point.reset();
    points.push_back(point);
  }
  return points;
}

}  // namespace

std::vector<StartHypothesis> start_by_two_views(const CameraModel& camera,
                                                const ReconstructionOptions& options,
                                                const StartWindow& window, Eigen::Index other,
                                                const std::vector<TwoViewMotion>& motions) {
  const ResectionOptions resection{options.max_reprojection_px, options.robust_px,
                                   options.min_resection_inliers, options.min_resection_ratio};
  std::vector<StartHypothesis> hypotheses;
  std::vector<PointMatch> matches;
  for (const TwoViewMotion& motion : motions) {
    const Pose& other_from_first = motion.second_from_first;
    const auto points = triangulate_pair(window, other, other_from_first,
                                         rad_from_deg(0.5 * options.min_triangulation_deg));
    StartHypothesis hypothesis{StartMethod::kTwoViews, {}};
    Pose predicted = Pose::Identity();
    for (Eigen::Index f = 0; f < window.frame_count(); ++f) {
      if (f == 0 || f == other) {
        predicted = f == 0 ? Pose::Identity() : other_from_first;
        hypothesis.eye_from_scene.emplace_back(predicted);
        continue;
      }
      window.find_matches(f, points, matches);
      const auto resected = refine_pose(camera, matches, predicted, resection);
      hypothesis.eye_from_scene.push_back(std::nullopt);
      if (!resected) continue;
      predicted = resected->eye_from_scene;
      hypothesis.eye_from_scene.back() = predicted;
    }
    hypotheses.push_back(std::move(hypothesis));
  }
  return hypotheses;
}

}  // namespace handeye
