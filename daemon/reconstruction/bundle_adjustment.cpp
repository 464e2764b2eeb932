// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/bundle_adjustment.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include "daemon/adjustment/pose_manifold.hpp"
#include "daemon/adjustment/reprojection_cost.hpp"

namespace handeye {
namespace {

/// Above this many moving keyframes the reduced camera system is solved as a sparse one.
constexpr int kDenseKeyframes = 40;

/// The Ceres problem over the keyframes and points that a window touches.
class Adjustment {
 public:
  /// `freedom`: null holds the lens.
  Adjustment(const CameraModel& camera, const LensFreedom* freedom,
             const AdjustmentOptions& options, Scene& scene)
      : camera_(camera),
        freedom_(freedom),
        lens_(lens_vector(camera)),
        options_(options),
        scene_(scene),
        loss_(options.robust_px),
        problem_(problem_options()) {
    for (const Keyframe& keyframe : scene.keyframes) {
      poses_.push_back(to_parameters(keyframe.eye_from_scene));
    }
    used_.resize(poses_.size(), false);
  }

  double solve() {
    add_observations();
    if (problem_.NumResidualBlocks() == 0) return 0.0;
    fix_gauge();
    if (freedom_ != nullptr) add_lens();
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(), &problem_, &summary);
    if (summary.IsSolutionUsable()) write_back();
    return rms_px();
  }

  CameraModel camera() const { return with_lens(camera_, lens_); }

 private:
  static ceres::Problem::Options problem_options() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  bool takes_part(const TrackObservation& seen) const {
    return seen.inlier && seen.keyframe >= options_.first_variable - options_.max_fixed;
  }

  void add_observations() {
    for (Track& track : scene_.tracks) {
      if (!track.has_point) continue;
      const auto& observations = track.observations;
      if (observations.empty() || observations.back().keyframe < options_.first_variable) continue;
      const auto count = std::count_if(observations.begin(), observations.end(),
                                       [this](const auto& seen) { return takes_part(seen); });
      if (count < 2) continue;
      for (const TrackObservation& seen : observations) {
        if (takes_part(seen)) add_observation(seen, track.point_scene.data());
      }
      points_.push_back(track.point_scene.data());
    }
  }

  void add_observation(const TrackObservation& seen, double* point_scene) {
    const auto keyframe = static_cast<std::size_t>(seen.keyframe);
    double* const pose = poses_[keyframe].data();
    if (freedom_ != nullptr) {
      reprojections_.push_back(problem_.AddResidualBlock(
          new LensReprojectionCost(camera_, seen.pixel), &loss_, pose, point_scene, lens_.data()));
    } else {
      reprojections_.push_back(problem_.AddResidualBlock(new ReprojectionCost(camera_, seen.pixel),
                                                         &loss_, pose, point_scene));
    }
    used_[keyframe] = true;
  }

  /// The prior of the lens, in px of reprojection error, and what of it stays.
  void add_lens() {
    const LensVector weights = freedom_->noise_px * freedom_->prior.sigma.cwiseInverse();
    problem_.AddResidualBlock(
        new ceres::NormalPrior(weights.asDiagonal().toDenseMatrix(), freedom_->prior.mean), nullptr,
        lens_.data());
    std::vector<int> held;
    for (int i = 0; i < kLensParameters; ++i) {
      if (!freedom_->free[static_cast<std::size_t>(i)]) held.push_back(i);
    }
    if (held.empty()) return;
    lens_manifold_ = std::make_unique<ceres::SubsetManifold>(kLensParameters, held);
    problem_.SetManifold(lens_.data(), lens_manifold_.get());
  }

  void fix_gauge() {
    std::vector<std::size_t> variable;
    int fixed = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (!used_[i]) continue;
      if (static_cast<int>(i) < options_.first_variable) {
        problem_.SetParameterBlockConstant(poses_[i].data());
        ++fixed;
      } else {
        problem_.SetManifold(poses_[i].data(), &manifold_);
        variable.push_back(i);
      }
    }
    if (fixed >= 2 || variable.size() < 2) return;
    const std::size_t reference = variable.front();
    if (fixed == 0) problem_.SetParameterBlockConstant(poses_[reference].data());
    fix_scale(scene_.keyframes[reference].eye_from_scene, variable);
  }

  /// One translation component of the keyframe farthest from the reference keeps its value. It must
  /// be one along which that camera really moved, or the scale would stay free.
  void fix_scale(const Pose& reference, const std::vector<std::size_t>& variable) {
    double largest = -1.0;
    std::size_t farthest = variable.back();
    for (const std::size_t i : variable) {
      const Pose& pose = scene_.keyframes[i].eye_from_scene;
      const double distance = (pose * reference.inverse()).translation().norm();
      if (distance > largest) {
        largest = distance;
        farthest = i;
      }
    }
    const Pose& pose = scene_.keyframes[farthest].eye_from_scene;
    int axis = 0;
    (pose * reference.inverse()).translation().cwiseAbs().maxCoeff(&axis);
    problem_.SetManifold(poses_[farthest].data(),
                         &fixed_axis_manifolds_[static_cast<std::size_t>(axis)]);
  }

  ceres::Solver::Options solver_options() {
    ceres::Solver::Options solver;
    const bool dense = static_cast<int>(poses_.size()) - options_.first_variable <= kDenseKeyframes;
    solver.linear_solver_type = dense ? ceres::DENSE_SCHUR : ceres::SPARSE_SCHUR;
    solver.max_num_iterations = options_.max_iterations;
    solver.function_tolerance = options_.function_tolerance;
    solver.gradient_tolerance = 1e-12;
    solver.parameter_tolerance = 1e-10;
    solver.num_threads = options_.threads;
    solver.logging_type = ceres::SILENT;
    auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (double* point : points_) ordering->AddElementToGroup(point, 0);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (used_[i]) ordering->AddElementToGroup(poses_[i].data(), 1);
    }
    if (freedom_ != nullptr) ordering->AddElementToGroup(lens_.data(), 1);
    solver.linear_solver_ordering = ordering;
    return solver;
  }

  void write_back() {
    for (auto i = static_cast<std::size_t>(options_.first_variable); i < poses_.size(); ++i) {
      if (used_[i]) scene_.keyframes[i].eye_from_scene = to_pose(poses_[i].data());
    }
  }

  double rms_px() {
    ceres::Problem::EvaluateOptions evaluate;
    evaluate.apply_loss_function = false;
    evaluate.residual_blocks = reprojections_;
    double cost = 0.0;
    problem_.Evaluate(evaluate, &cost, nullptr, nullptr, nullptr);
    return std::sqrt(2.0 * cost / static_cast<double>(reprojections_.size()));
  }

  const CameraModel& camera_;
  const LensFreedom* freedom_;
  LensVector lens_;
  const AdjustmentOptions& options_;
  Scene& scene_;
  std::vector<PoseParameters> poses_;
  std::vector<double*> points_;
  std::vector<bool> used_;
  std::vector<ceres::ResidualBlockId> reprojections_;
  // What the problem refers to is declared before it, and so outlives it.
  ceres::HuberLoss loss_;
  PoseManifold manifold_;
  std::array<PoseManifold, 3> fixed_axis_manifolds_{PoseManifold(0), PoseManifold(1),
                                                    PoseManifold(2)};
  std::unique_ptr<ceres::SubsetManifold> lens_manifold_;
  ceres::Problem problem_;
};

}  // namespace

double adjust(const CameraModel& camera, const AdjustmentOptions& options, Scene& scene) {
  return Adjustment(camera, nullptr, options, scene).solve();
}

double adjust(const LensFreedom& freedom, const AdjustmentOptions& options, Scene& scene,
              CameraModel& camera) {
  const CameraModel start = camera;
  Adjustment adjustment(start, &freedom, options, scene);
  const double rms_px = adjustment.solve();
  camera = adjustment.camera();
  scene.refresh_rays(camera);
  return rms_px;
}

}  // namespace handeye
