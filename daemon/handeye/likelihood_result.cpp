// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/likelihood_result.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "daemon/handeye/pose_covariance.hpp"
#include "daemon/handeye/scale_profile.hpp"

namespace handeye {
namespace {

constexpr double kDoubtedLogScale = 0.003;  // sigma from which on other scales are tried
constexpr double kUndecidedSigmas = 0.5;    // standard deviations that an undecided distance is

double square(double x) {
  return x * x;
}

double degrees_of_freedom(const PoseProblem& problem, std::size_t part) {
  return 6.0 * static_cast<double>(problem.poses_kept(part)) - problem.parameters_of(part);
}

/// The residuals of the parts in use, weighed against the noise.
struct Weighed {
  std::vector<std::vector<Vector6d>> whitened_of_parts;  ///< by the noise that was fitted
  std::vector<std::vector<double>> chi2_of_parts;        ///< against the noise that was assumed
  double freedom{0};
};

Weighed weigh(const PoseProblem& problem, const PartNoise& variances,
              const MaximumLikelihoodOptions& options) {
  const ResidualNoise noise(problem.unknowns().common().eye_in_hand_mm);
  const Matrix6d assumed = noise.whitening(variances_of(options.noise));
  Weighed weighed;
  for (const std::size_t p : parts_in_use(problem)) {
    const Matrix6d whitening = noise.whitening(variances[p]);
    std::vector<Vector6d> whitened = problem.residuals(p);
    std::vector<double> chi2;
    for (Vector6d& residual : whitened) {
      chi2.push_back((assumed * residual).squaredNorm());
      residual = whitening * residual;
    }
    weighed.whitened_of_parts.push_back(std::move(whitened));
    weighed.chi2_of_parts.push_back(std::move(chi2));
    weighed.freedom += degrees_of_freedom(problem, p);
  }
  weighed.freedom = std::max(1.0, weighed.freedom);
  return weighed;
}

/// Noise that was given is believed within what chance explains; beyond it, by how much is it
/// exceeded.
double excess(const Weighed& weighed, double huber) {
  double chi2 = 0;
  for (const std::vector<Vector6d>& of_part : weighed.whitened_of_parts) {
    for (const Vector6d& whitened : of_part) {
      const double norm = whitened.norm();
      chi2 += std::min(norm, huber) * norm;
    }
  }
  const double chance = 1.0 + 3.3 * std::sqrt(2.0 / weighed.freedom);
  return chi2 / weighed.freedom > chance ? chi2 / weighed.freedom : 1.0;
}

/// Of all unknowns, with what linearisation does not see of the scales.
PartedMatrix covariance_of(const PoseProblem& problem, const PartNoise& noise, double inflation,
                           const MaximumLikelihoodOptions& options) {
  PartedMatrix covariance =
      inflation * covariance_of_unknowns(problem, noise, options.estimate_noise);
  if (!options.estimate_scale) return covariance;
  for (const std::size_t p : parts_in_use(problem)) {
    const Eigen::Index scale = index_of(kLogScale, p);
    if (!(covariance(scale, scale) > square(kDoubtedLogScale))) continue;
    const double undecided = undecided_log_scale(problem, p, options, noise, inflation);
    widen_scale(covariance, scale, kUndecidedSigmas * undecided);
  }
  return covariance;
}

/// As sigma_translation_mm, were the scales known: conditioned on one after the other.
double sigma_with_known_scales(PartedMatrix covariance, const PoseProblem& problem) {
  double square_sum = covariance.block<3, 3>(kEyeShift, kEyeShift).trace();
  for (const std::size_t p : parts_in_use(problem)) {
    const Eigen::Index scale = index_of(kLogScale, p);
    const PartedVector column = covariance.col(scale);
    square_sum -= column.segment<3>(kEyeShift).squaredNorm() / column[scale];
    covariance -= column * column.transpose() / column[scale];
  }
  return std::sqrt(std::max(0.0, square_sum));
}

std::vector<PartResult> describe_parts(const PoseProblem& problem, const PartNoise& noise,
                                       const PartAgreement& agreement,
                                       const PartedMatrix& covariance, bool estimate_scale) {
  std::vector<PartResult> results;
  for (std::size_t p = 0; p < problem.parts().size(); ++p) {
    const Part& part = problem.parts()[p];
    PartResult result{.number = part.number,
                      .poses = part.members.size(),
                      .poses_used = problem.poses_kept(p),
                      .scale_units_per_mm = problem.solution(p).scale_units_per_mm,
                      .room_from_scene = problem.room_from_scene(p),
                      .noise = noise_of(noise[p]),
                      .disagreement_chi2 = agreement.disagreement_chi2[p]};
    const Eigen::Index scale = index_of(kLogScale, p);
    if (estimate_scale) result.log_scale_sigma = std::sqrt(covariance(scale, scale));
    results.push_back(result);
  }
  return results;
}

}  // namespace

MaximumLikelihoodResult describe(const PoseProblem& problem, const PartNoise& noise,
                                 const PartAgreement& agreement,
                                 const MaximumLikelihoodOptions& options) {
  const std::vector<std::size_t> used = parts_in_use(problem);
  const Weighed weighed = weigh(problem, noise, options);

  MaximumLikelihoodResult result;
  result.disagreement_inflation = agreement.inflation;
  if (options.account_for_correlation) {
    result.correlation_inflation = correlation_time(weighed.whitened_of_parts);
  }
  const double inflation = result.disagreement_inflation * result.correlation_inflation *
                           (options.estimate_noise ? 1.0 : excess(weighed, options.huber));
  const PartedMatrix covariance = covariance_of(problem, noise, inflation, options);
  result.covariance = covariance.topLeftCorner<6, 6>();

  result.parts = describe_parts(problem, noise, agreement, covariance, options.estimate_scale);
  for (std::size_t i = 0; i < used.size(); ++i) {
    PartResult& part = result.parts[used[i]];
    const double freedom = std::max(1.0, degrees_of_freedom(problem, used[i]));
    for (const double chi2 : weighed.chi2_of_parts[i]) {
      part.chi2_per_dof += chi2 / freedom;
      result.chi2_per_dof += chi2 / weighed.freedom;
    }
    result.poses_used += part.poses_used;
  }
  const PartResult& answer = result.parts[used.front()];
  result.solution = problem.solution(used.front());
  result.part = answer.number;
  result.room_from_scene = answer.room_from_scene;
  result.noise = answer.noise;
  result.log_scale_sigma = answer.log_scale_sigma;
  for (std::size_t k = 0; k < problem.kept().size(); ++k) {
    if (!problem.kept()[k]) result.rejected.push_back(k);
  }
  result.sigma_translation_known_scale_mm = options.estimate_scale
                                                ? sigma_with_known_scales(covariance, problem)
                                                : result.sigma_translation_mm();
  if (options.estimate_time_offset) {
    result.time_offset_correction_s = problem.unknowns().common().time_offset_s;
    result.time_offset_sigma_s = std::sqrt(covariance(kTimeOffset, kTimeOffset));
  }
  return result;
}

}  // namespace handeye
