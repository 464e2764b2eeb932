// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/pose_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "daemon/handeye/residual_whitening.hpp"

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
    : options_(options),
      poses_(observations, start, options.estimate_scale),
      unknowns_(poses_.placed(start.hand_from_eye)),
      prior_log_scales_(poses_.parts.size(), 0.0),
      noise_log_scales_(poses_.parts.size(), 0.0) {
  std::vector<bool> counting(observations.size(), false);
  for (const Part& part : parts()) {
    const bool largest = &part == &parts().front();
    if (!largest && part.members.size() < kFewestPosesOfPart) continue;
    for (const std::size_t k : part.members) counting[k] = true;
  }
  keep(std::move(counting));
}

void PoseProblem::keep(std::vector<bool> kept) {
  kept_ = std::move(kept);
  poses_kept_.clear();
  for (const Part& part : parts()) {
    poses_kept_.push_back(static_cast<std::size_t>(
        std::ranges::count_if(part.members, [&](std::size_t k) { return kept_[k]; })));
  }
}

double PoseProblem::loss(double norm) const {
  return norm <= options_.huber ? 0.5 * square(norm)
                                : options_.huber * (norm - 0.5 * options_.huber);
}

double PoseProblem::prior_cost(const PartedUnknowns& unknowns) const {
  double result = 0;
  for (std::size_t p = 0; p < parts().size(); ++p) {
    if (!estimates(kLogScale, p)) continue;
    const double correction = unknowns.of(p).log_scale - prior_log_scales_[p];
    result += 0.5 * square(correction / options_.log_scale_prior);
  }
  if (options_.estimate_time_offset) {
    result += 0.5 * square(unknowns.common().time_offset_s / options_.time_offset_prior_s);
  }
  return result;
}

void PoseProblem::add_cost(std::size_t part, const PartNoise& noise, const PartedUnknowns& unknowns,
                           double& cost) const {
  const PoseUnknowns& own = unknowns.of(part);
  const ResidualWhitening whitening(noise[part], noise_log_scales_[part], own);
  for (const std::size_t k : parts()[part].members) {
    if (kept_[k]) cost += loss(whitening.value(pose_residual(poses_.poses[k], own)).norm());
  }
}

double PoseProblem::cost_of(std::size_t part, const PartNoise& noise) const {
  double result = 0;
  add_cost(part, noise, unknowns_, result);
  return result;
}

double PoseProblem::cost(const PartNoise& noise, const PartedUnknowns& unknowns) const {
  double result = prior_cost(unknowns);
  for (std::size_t p = 0; p < parts().size(); ++p) {
    if (in_use(p)) add_cost(p, noise, unknowns, result);
  }
  return result;
}

void PoseProblem::add_poses(std::size_t part, const PartNoise& noise,
                            const PartedUnknowns& unknowns, NormalEquations& equations,
                            bool with_information) const {
  const PoseUnknowns& own = unknowns.of(part);
  const ResidualWhitening whitening(noise[part], noise_log_scales_[part], own);
  UnknownsVector gradient = UnknownsVector::Zero();
  UnknownsMatrix information = UnknownsMatrix::Zero();
  for (const std::size_t k : parts()[part].members) {
    if (!kept_[k]) continue;
    PoseResidual residual = pose_residual_with_jacobian(poses_.poses[k], own);
    whitening.apply(residual);
    const double norm = residual.value.norm();
    const double weight = norm <= options_.huber ? 1.0 : options_.huber / norm;
    equations.cost += loss(norm);
    gradient.noalias() += residual.jacobian.transpose() * (weight * residual.value);
    if (with_information) {
      information.noalias() += residual.jacobian.transpose() * (weight * residual.jacobian);
    }
  }
  add_part(gradient, part, equations.gradient);
  if (with_information) add_part(information, part, equations.information);
}

void PoseProblem::add_priors(const PartedUnknowns& unknowns, NormalEquations& equations,
                             bool with_information) const {
  const auto add = [&](Eigen::Index index, double value, double sigma) {
    equations.gradient[index] += value / square(sigma);
    if (with_information) equations.information(index, index) += 1.0 / square(sigma);
  };
  const auto fix = [&](Eigen::Index index) {
    equations.gradient[index] = 0;
    if (!with_information) return;
    equations.information.row(index).setZero();
    equations.information.col(index).setZero();
    equations.information(index, index) = 1;
  };
  for (std::size_t p = 0; p < parts().size(); ++p) {
    for (int i = kSceneTurn; i < kTimeOffset; ++i) {
      if (!estimates(i, p)) fix(index_of(i, p));
    }
    if (estimates(kLogScale, p)) {
      add(index_of(kLogScale, p), unknowns.of(p).log_scale - prior_log_scales_[p],
          options_.log_scale_prior);
    }
  }
  if (options_.estimate_time_offset) {
    add(kTimeOffset, unknowns.common().time_offset_s, options_.time_offset_prior_s);
  } else {
    fix(kTimeOffset);
  }
}

PoseProblem::NormalEquations PoseProblem::equations_at(const PartNoise& noise,
                                                       const PartedUnknowns& unknowns,
                                                       bool with_information) const {
  const Eigen::Index size = unknowns_of_parts(parts().size());
  NormalEquations equations{.cost = prior_cost(unknowns), .gradient = PartedVector::Zero(size)};
  if (with_information) equations.information = PartedMatrix::Zero(size, size);
  for (std::size_t p = 0; p < parts().size(); ++p) {
    if (in_use(p)) add_poses(p, noise, unknowns, equations, with_information);
  }
  add_priors(unknowns, equations, with_information);
  return equations;
}

void PoseProblem::minimise(const PartNoise& noise) {
  for (std::size_t p = 0; p < parts().size(); ++p) {
    prior_log_scales_[p] = unknowns_.of(p).log_scale;
    if (noise_follows_) noise_log_scales_[p] = unknowns_.of(p).log_scale;
  }
  NormalEquations now = equations_at(noise, unknowns_, true);
  double damping = 0;
  for (int iteration = 0; iteration < kMaxIterations && damping < kMaxDamping; ++iteration) {
    if (!(now.cost > kExact * static_cast<double>(poses_.poses.size()))) break;
    // In units of the diagonal, so that damping means the same for rad and mm.
    const PartedVector unit =
        now.information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    PartedMatrix scaled = unit.asDiagonal() * now.information * unit.asDiagonal();
    scaled.diagonal().array() += damping;
    const PartedVector right = -unit.cwiseProduct(now.gradient);
    const PartedVector solved = scaled.ldlt().solve(right);
    const PartedVector step = unit.cwiseProduct(solved);
    if (!step.allFinite()) {
      damping = std::max(10.0 * damping, kLeastDamping);
      continue;
    }
    const double expected = 0.5 * (dot(right, solved) + damping * dot(solved, solved));
    if (expected < kSettled * now.cost) break;
    const PartedUnknowns next = unknowns_.moved_by(step);
    const double next_cost = cost(noise, next);
    if (next_cost < now.cost) {
      unknowns_ = next;
      now = equations_at(noise, unknowns_, true);
      damping = damping > kLeastDamping ? 0.1 * damping : 0.0;
    } else {
      damping = std::max(10.0 * damping, kLeastDamping);
    }
  }
}

void PoseProblem::hold_scale(std::size_t part, double log_scale) {
  held_scale_ = part;
  noise_follows_ = false;
  unknowns_.set_log_scale(part, log_scale);
}

void PoseProblem::noise_holds_at(std::span<const double> scales_units_per_mm) {
  for (std::size_t p = 0; p < parts().size(); ++p) {
    noise_log_scales_[p] = std::log(scales_units_per_mm[p] / poses_.scales_units_per_mm[p]);
  }
  noise_follows_ = false;
}

std::vector<double> PoseProblem::norms(const PartNoise& noise) const {
  std::vector<double> result(poses_.poses.size(), std::numeric_limits<double>::infinity());
  for (std::size_t p = 0; p < parts().size(); ++p) {
    if (!in_use(p)) continue;
    const ResidualWhitening whitening(noise[p], noise_log_scales_[p], unknowns_.of(p));
    for (const std::size_t k : parts()[p].members) {
      result[k] = whitening.value(pose_residual(poses_.poses[k], unknowns_.of(p))).norm();
    }
  }
  return result;
}

std::vector<Vector6d> PoseProblem::residuals(std::size_t part) const {
  std::vector<Vector6d> result;
  result.reserve(poses_kept_[part]);
  for (const std::size_t k : parts()[part].members) {
    if (kept_[k]) result.push_back(pose_residual(poses_.poses[k], unknowns_.of(part)));
  }
  return result;
}

bool PoseProblem::estimates(int unknown, std::size_t part) const {
  if (unknown == kTimeOffset) return options_.estimate_time_offset;
  if (is_common(unknown)) return true;
  const bool free = unknown != kLogScale || (options_.estimate_scale && held_scale_ != part);
  return free && in_use(part);
}

double PoseProblem::parameters_of(std::size_t part) const {
  const int common = 6 + (options_.estimate_time_offset ? 1 : 0);
  const int own = 6 + (options_.estimate_scale ? 1 : 0);
  std::size_t kept = 0;
  for (const std::size_t n : poses_kept_) kept += n;
  return own + common * static_cast<double>(poses_kept_[part]) / static_cast<double>(kept);
}

HandEyeSolution PoseProblem::solution(std::size_t part) const {
  const PoseUnknowns& own = unknowns_.of(part);
  const double start_scale = poses_.scales_units_per_mm[part];
  return {make_pose(own.hand_from_eye, own.eye_in_hand_mm),
          options_.estimate_scale ? start_scale * std::exp(own.log_scale) : start_scale};
}

}  // namespace handeye
