// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/halves.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/parts.hpp"

namespace handeye {
namespace {

/// Nothing: no such part.
const PartResult* part_of(const MaximumLikelihoodResult& result, int number) {
  const auto found = std::ranges::find(result.parts, number, &PartResult::number);
  return found == result.parts.end() ? nullptr : &*found;
}

std::vector<HandEyeObservation> of_used_parts(std::span<const HandEyeObservation> observations,
                                              const MaximumLikelihoodResult& result) {
  std::vector<HandEyeObservation> used;
  for (const HandEyeObservation& observation : observations) {
    const PartResult* part = part_of(result, observation.part);
    if (part && part->poses_used > 0) used.push_back(observation);
  }
  return used;
}

struct Halves {
  std::vector<HandEyeObservation> first;
  std::vector<HandEyeObservation> second;
};

/// Each part halved by itself, so that both halves saw the same motions: whether parts agree is
/// asked elsewhere (part_agreement.hpp).
Halves halves_of(std::span<const HandEyeObservation> observations, bool in_order_of_time) {
  std::vector<bool> is_first(observations.size());
  for (const Part& part : parts_of(observations)) {
    for (std::size_t m = 0; m < part.members.size(); ++m) {
      is_first[part.members[m]] = in_order_of_time ? m < part.members.size() / 2 : m % 2 == 0;
    }
  }
  Halves halves;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    (is_first[k] ? halves.first : halves.second).push_back(observations[k]);
  }
  return halves;
}

/// From the answer of the whole, with the scale of the half's largest part.
std::optional<MaximumLikelihoodResult> solve(std::span<const HandEyeObservation> half,
                                             const MaximumLikelihoodResult& whole,
                                             const MaximumLikelihoodOptions& solver) {
  if (half.empty()) return std::nullopt;
  HandEyeSolution start = whole.solution;
  if (const PartResult* part = part_of(whole, parts_of(half).front().number)) {
    start.scale_units_per_mm = part->scale_units_per_mm;
  }
  return maximum_likelihood(half, start, solver);
}

}  // namespace

Vector6d HalvesOfWhole::error_of_whole() const {
  // In units in which the difference's covariance is 1: a whole that adds up its halves has 1/4.
  const Eigen::LLT<Matrix6d> unit(covariance);
  const Matrix6d half_way = unit.matrixL().solve(of_whole);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
      unit.matrixL().solve(half_way.transpose()).eval());
  const Vector6d along = eigen.eigenvectors().transpose() * unit.matrixL().solve(difference);
  const Vector6d share = 2.0 * eigen.eigenvalues().cwiseMax(0.0).cwiseMin(0.25);
  return unit.matrixL() * (eigen.eigenvectors() * share.cwiseProduct(along));
}

HalvesComparison compare(const Pose& first, const Pose& second, const Matrix6d& covariance) {
  HalvesComparison comparison{.covariance = covariance};
  comparison.difference << log_so3(first.linear() * second.linear().transpose()),
      first.translation() - second.translation();
  comparison.chi2 = comparison.difference.dot(covariance.ldlt().solve(comparison.difference));
  return comparison;
}

std::optional<HalvesOfWhole> compare_halves(std::span<const HandEyeObservation> observations,
                                            const MaximumLikelihoodResult& result,
                                            const MaximumLikelihoodOptions& solver) {
  const Halves halves =
      halves_of(of_used_parts(observations, result), solver.account_for_correlation);
  const auto first = solve(halves.first, result, solver);
  const auto second = solve(halves.second, result, solver);
  if (!first || !second) return std::nullopt;
  return HalvesOfWhole{compare(first->solution.hand_from_eye, second->solution.hand_from_eye,
                               first->covariance + second->covariance),
                       result.covariance};
}

}  // namespace handeye
