// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/pose_problem.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "daemon/handeye/residual_whitening.hpp"
#include "daemon/handeye/scene_placement.hpp"

namespace handeye {
namespace {

constexpr int kMaxIterations = 100;
constexpr double kSettled = 1e-15;      // relative decrease of the cost that is still expected
constexpr double kExact = 1e-20;        // cost of a pose that is as good as none
constexpr double kMaxDamping = 1e10;    // no step is small enough: at the limit of rounding
constexpr double kLeastDamping = 1e-9;  // what the first step that fails is repeated with

double square(double x) {
  return x * x;
}

}  // namespace

PoseProblem::PoseProblem(std::span<const HandEyeObservation> observations,
                         const HandEyeSolution& start, const MaximumLikelihoodOptions& options)
    : options_(options), kept_(observations.size(), true), start_scale_(start.scale_units_per_mm) {
  unknowns_.hand_from_eye = Eigen::Quaterniond(start.hand_from_eye.linear()).normalized();
  unknowns_.eye_in_hand_mm = start.hand_from_eye.translation();
  poses_.reserve(observations.size());
  const auto n = static_cast<double>(observations.size());
  for (const HandEyeObservation& observation : observations) {
    const Pose& hand = observation.poses.room_from_hand;
    const Pose eye = observation.poses.eye_from_scene.inverse();
    poses_.push_back({Eigen::Quaterniond(hand.linear()).normalized(), hand.translation(),
                      Eigen::Quaterniond(eye.linear()).normalized(),
                      eye.translation() / start_scale_, observation.hand_angular_velocity,
                      observation.hand_velocity});
    room_centre_mm_ += poses_.back().hand_in_room_mm / n;
    scene_centre_mm_ += poses_.back().eye_in_scene_mm / n;
  }

  for (CentredPose& pose : poses_) {
    pose.hand_in_room_mm -= room_centre_mm_;
    pose.eye_in_scene_mm -= scene_centre_mm_;
  }
  place_scene(poses_, unknowns_);
}

double PoseProblem::loss(double norm) const {
  return norm <= options_.huber ? 0.5 * square(norm)
                                : options_.huber * (norm - 0.5 * options_.huber);
}

double PoseProblem::prior_cost(const PoseUnknowns& unknowns) const {
  double result = 0;
  if (options_.estimate_scale) {
    result += 0.5 * square((unknowns.log_scale - prior_log_scale_) / options_.log_scale_prior);
  }
  if (options_.estimate_time_offset) {
    result += 0.5 * square(unknowns.time_offset_s / options_.time_offset_prior_s);
  }
  return result;
}

double PoseProblem::cost(const ResidualNoise::Variances& noise,
                         const PoseUnknowns& unknowns) const {
  const ResidualWhitening whitening(noise, noise_log_scale_, unknowns);
  double result = prior_cost(unknowns);
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (kept_[k]) result += loss(whitening.value(pose_residual(poses_[k], unknowns)).norm());
  }
  return result;
}

void PoseProblem::add_poses(const ResidualNoise::Variances& noise, const PoseUnknowns& unknowns,
                            double& cost, UnknownsVector& gradient,
                            UnknownsMatrix* information) const {
  const ResidualWhitening whitening(noise, noise_log_scale_, unknowns);
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (!kept_[k]) continue;
    PoseResidual residual = pose_residual_with_jacobian(poses_[k], unknowns);
    whitening.apply(residual);
    const double norm = residual.value.norm();
    const double weight = norm <= options_.huber ? 1.0 : options_.huber / norm;
    cost += loss(norm);
    gradient.noalias() += residual.jacobian.transpose() * (weight * residual.value);
    if (information) {
      information->noalias() += residual.jacobian.transpose() * (weight * residual.jacobian);
    }
  }
}

void PoseProblem::add_priors(const PoseUnknowns& unknowns, UnknownsVector& gradient,
                             UnknownsMatrix* information) const {
  const auto add = [&](int index, double value, double sigma) {
    if (estimates(index)) {
      gradient[index] += value / square(sigma);
      if (information) (*information)(index, index) += 1.0 / square(sigma);
    } else {
      gradient[index] = 0;
      if (!information) return;
      information->row(index).setZero();
      information->col(index).setZero();
      (*information)(index, index) = 1;
    }
  };
  add(kLogScale, unknowns.log_scale - prior_log_scale_, options_.log_scale_prior);
  add(kTimeOffset, unknowns.time_offset_s, options_.time_offset_prior_s);
}

PoseProblem::NormalEquations PoseProblem::normal_equations(const ResidualNoise::Variances& noise,
                                                           const PoseUnknowns& unknowns) const {
  NormalEquations equations;
  equations.cost = prior_cost(unknowns);
  add_poses(noise, unknowns, equations.cost, equations.gradient, &equations.information);
  add_priors(unknowns, equations.gradient, &equations.information);
  return equations;
}

UnknownsVector PoseProblem::gradient(const ResidualNoise::Variances& noise,
                                     const PoseUnknowns& unknowns) const {
  double cost = 0;
  UnknownsVector result = UnknownsVector::Zero();
  add_poses(noise, unknowns, cost, result, nullptr);
  add_priors(unknowns, result, nullptr);
  return result;
}

void PoseProblem::minimise(const ResidualNoise::Variances& noise) {
  prior_log_scale_ = unknowns_.log_scale;
  if (noise_follows_) noise_log_scale_ = unknowns_.log_scale;
  NormalEquations now = normal_equations(noise, unknowns_);
  double damping = 0;
  for (int iteration = 0; iteration < kMaxIterations && damping < kMaxDamping; ++iteration) {
    if (!(now.cost > kExact * static_cast<double>(poses_.size()))) break;
    // In units of the diagonal, so that damping means the same for rad and mm.
    const UnknownsVector unit =
        now.information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    UnknownsMatrix scaled = unit.asDiagonal() * now.information * unit.asDiagonal();
    scaled.diagonal().array() += damping;
    const UnknownsVector right = -unit.cwiseProduct(now.gradient);
    const UnknownsVector solved = scaled.ldlt().solve(right);
    const UnknownsVector step = unit.cwiseProduct(solved);
    if (!step.allFinite()) {
      damping = std::max(10.0 * damping, kLeastDamping);
      continue;
    }
    const double expected = 0.5 * (right.dot(solved) + damping * solved.squaredNorm());
    if (expected < kSettled * now.cost) break;
    const PoseUnknowns next = unknowns_.moved_by(step);
    const double next_cost = cost(noise, next);
    if (next_cost < now.cost) {
      unknowns_ = next;
      now = normal_equations(noise, unknowns_);
      damping = damping > kLeastDamping ? 0.1 * damping : 0.0;
    } else {
      damping = std::max(10.0 * damping, kLeastDamping);
    }
  }
}

void PoseProblem::hold_scale(double log_scale) {
  options_.estimate_scale = false;
  noise_follows_ = false;
  unknowns_.log_scale = log_scale;
}

void PoseProblem::noise_holds_at(double scale_units_per_mm) {
  noise_log_scale_ = std::log(scale_units_per_mm / start_scale_);
  noise_follows_ = false;
}

std::vector<double> PoseProblem::norms(const ResidualNoise::Variances& noise) const {
  const ResidualWhitening whitening(noise, noise_log_scale_, unknowns_);
  std::vector<double> result;
  result.reserve(poses_.size());
  for (const CentredPose& pose : poses_) {
    result.push_back(whitening.value(pose_residual(pose, unknowns_)).norm());
  }
  return result;
}

std::vector<Vector6d> PoseProblem::residuals() const {
  std::vector<Vector6d> result;
  result.reserve(poses_.size());
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    if (kept_[k]) result.push_back(pose_residual(poses_[k], unknowns_));
  }
  return result;
}

bool PoseProblem::estimates(int unknown) const {
  if (unknown == kLogScale) return options_.estimate_scale;
  return unknown != kTimeOffset || options_.estimate_time_offset;
}

int PoseProblem::parameters() const {
  return 12 + (options_.estimate_scale ? 1 : 0) + (options_.estimate_time_offset ? 1 : 0);
}

HandEyeSolution PoseProblem::solution() const {
  return {make_pose(unknowns_.hand_from_eye, unknowns_.eye_in_hand_mm),
          options_.estimate_scale ? start_scale_ * std::exp(unknowns_.log_scale) : start_scale_};
}

Pose PoseProblem::room_from_scene() const {
  // The scene is scaled about its origin, not about the mean of the eyes.
  const Eigen::Vector3d centre_mm = scene_centre_mm_ * std::exp(-unknowns_.log_scale);
  return make_pose(unknowns_.room_from_scene, unknowns_.scene_in_room_mm + room_centre_mm_ -
                                                  unknowns_.room_from_scene * centre_mm);
}

}  // namespace handeye
