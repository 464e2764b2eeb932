// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_structure.hpp"

#include <array>
#include <utility>

#include <Eigen/Dense>
#include <ceres/ceres.h>

#include "daemon/adjustment/pose_manifold.hpp"
#include "daemon/adjustment/reprojection_cost.hpp"
#include "daemon/geometry/projection.hpp"

namespace handeye::synthetic {
namespace {

constexpr int kFewestKeyframes = 2;     // that see a point of the structure
constexpr double kMinParallax_deg = 1;  // between two of them

Pose scaled(Pose pose, double factor) {
  pose.translation() *= factor;
  return pose;
}

Pose eye_from_scene(const Pose& eye_from_room, const SceneOfPart& scene) {
  return scaled(eye_from_room * scene.room_from_scene, scene.units_per_mm);
}

bool has_parallax(const Tracks& tracks, const Track& track, const std::vector<int>& keyframes) {
  const auto ray = [&](int frame) {
    const Pose& eye_from_room = tracks.eye_from_room[static_cast<std::size_t>(frame)];
    return Eigen::Vector3d((track.point_room - eye_from_room.inverse().translation()).normalized());
  };
  for (const int frame : keyframes) {
    const Eigen::Vector3d across = ray(keyframes.front()).cross(ray(frame));
    if (across.norm() > std::sin(rad_from_deg(kMinParallax_deg))) return true;
  }
  return false;
}

/// Which tracks become points: place in `problem.points`, or -1.
std::vector<int> add_points(const Tracks& tracks, const std::vector<SceneOfPart>& scenes,
                            OneStepProblem& problem) {
  std::vector<int> place_of(tracks.tracks.size(), -1);
  for (std::size_t t = 0; t < tracks.tracks.size(); ++t) {
    const Track& track = tracks.tracks[t];
    std::vector<int> keyframes;
    for (int frame = track.first; frame < track.end(); ++frame) {
      if (problem.frames[static_cast<std::size_t>(frame)].keyframe) keyframes.push_back(frame);
    }
    if (static_cast<int>(keyframes.size()) < kFewestKeyframes) continue;
    if (!has_parallax(tracks, track, keyframes)) continue;
    const SceneOfPart& scene = scenes[static_cast<std::size_t>(track.part)];
    OneStepPoint point{
        .part = track.part,
        .point_scene = scene.units_per_mm * (scene.room_from_scene.inverse() * track.point_room)};
    for (const int frame : keyframes) {
      point.observations.push_back(
          {frame, track.pixels[static_cast<std::size_t>(frame - track.first)]});
    }
    place_of[t] = static_cast<int>(problem.points.size());
    problem.points.push_back(std::move(point));
  }
  return place_of;
}

struct LensPriorCost {
  const LensPrior& prior;
  template <typename T>
  bool operator()(const T* lens, T* residuals) const {
    for (int i = 0; i < kLensParameters; ++i) {
      residuals[i] = (lens[i] - prior.mean[i]) / prior.sigma[i];
    }
    return true;
  }
};

/// Keyframes and points to the minimum; the gauge stays about where it is (damping).
void adjust(const std::optional<LensPrior>& prior, double noise_px, OneStepProblem& problem) {
  std::vector<PoseParameters> poses;
  for (const OneStepFrame& frame : problem.frames) {
    poses.push_back(to_parameters(frame.eye_from_scene));
  }
  LensVector lens = lens_vector(problem.camera);
  PoseManifold manifold;
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem adjustment(ownership);
  ceres::ScaledLoss* weight = nullptr;
  for (OneStepPoint& point : problem.points) {
    for (const OneStepPoint::Observation& seen : point.observations) {
      double* pose = poses[static_cast<std::size_t>(seen.frame)].data();
      weight = new ceres::ScaledLoss(nullptr, 1 / (noise_px * noise_px), ceres::TAKE_OWNERSHIP);
      if (prior) {
        adjustment.AddResidualBlock(new LensReprojectionCost(problem.camera, seen.pixel), weight,
                                    pose, point.point_scene.data(), lens.data());
      } else {
        adjustment.AddResidualBlock(new ReprojectionCost(problem.camera, seen.pixel), weight, pose,
                                    point.point_scene.data());
      }
      adjustment.SetManifold(pose, &manifold);
    }
  }
  if (prior) {
    adjustment.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LensPriorCost, kLensParameters, kLensParameters>(
            new LensPriorCost{*prior}),
        nullptr, lens.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &adjustment, &summary);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    problem.frames[k].eye_from_scene = to_pose(poses[k].data());
  }
  if (prior) problem.camera = with_lens(problem.camera, lens);
}

struct Sighting {
  Eigen::Vector3d point_scene;
  Eigen::Vector2d pixel;
};

/// Gauss-Newton from near the minimum.
void resect(const CameraModel& camera, const std::vector<Sighting>& sightings,
            OneStepFrame& frame) {
  Matrix6d normal;
  for (int iteration = 0; iteration < 6; ++iteration) {
    normal.setZero();
    Vector6d right = Vector6d::Zero();
    for (const Sighting& sighting : sightings) {
      const Eigen::Vector3d turned = frame.eye_from_scene.linear() * sighting.point_scene;
      const Projection seen =
          project_with_derivative(camera, turned + frame.eye_from_scene.translation());
      Eigen::Matrix<double, 2, 6> by_pose;
      by_pose << -seen.by_point_eye * skew(turned), seen.by_point_eye;
      normal += by_pose.transpose() * by_pose;
      right += by_pose.transpose() * (sighting.pixel - seen.pixel);
    }
    const Vector6d step = normal.ldlt().solve(right);
    frame.eye_from_scene.linear() = exp_so3(step.head<3>()) * frame.eye_from_scene.linear();
    frame.eye_from_scene.translation() += step.tail<3>();
  }
  frame.unit_covariance = normal.ldlt().solve(Matrix6d::Identity());
}

}  // namespace

OneStepProblem reconstruct(const Tracks& tracks, const std::vector<SceneOfPart>& scenes,
                           int keyframe_interval, const std::optional<LensPrior>& lens,
                           double noise_px) {
  OneStepProblem problem{.camera = tracks.camera};
  for (std::size_t k = 0; k < tracks.eye_from_room.size(); ++k) {
    const int part = tracks.part[k];
    const SceneOfPart& scene = scenes[static_cast<std::size_t>(part)];
    problem.frames.push_back({.eye_from_scene = eye_from_scene(tracks.eye_from_room[k], scene),
                              .part = part,
                              .keyframe = k % static_cast<std::size_t>(keyframe_interval) == 0});
  }
  const std::vector<int> place_of = add_points(tracks, scenes, problem);
  adjust(lens, noise_px, problem);

  std::vector<std::vector<Sighting>> sightings(problem.frames.size());
  for (std::size_t t = 0; t < place_of.size(); ++t) {
    if (place_of[t] < 0) continue;
    const OneStepPoint& point = problem.points[static_cast<std::size_t>(place_of[t])];
    const Track& track = tracks.tracks[t];
    for (std::size_t i = 0; i < track.pixels.size(); ++i) {
      sightings[static_cast<std::size_t>(track.first) + i].push_back(
          {point.point_scene, track.pixels[i]});
    }
  }
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    if (!problem.frames[k].keyframe) resect(problem.camera, sightings[k], problem.frames[k]);
  }
  return problem;
}

}  // namespace handeye::synthetic
