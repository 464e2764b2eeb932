// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/maximum_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/noise_model.hpp"
#include "daemon/handeye/pose_problem.hpp"
#include "daemon/handeye/starts.hpp"

namespace handeye {
namespace {

constexpr std::size_t kMinPoses = 4;
constexpr double kPriorPoses = 5;               // so many poses' worth is the assumed noise
constexpr double kLargestForCorrelation = 6.0;  // norm to which outliers are cut
constexpr int kWeightIterations = 10;           // of noise and robust weights
constexpr double kLowestInformation =
    1e-13;  // of the scaled normal equations: beyond it, not observed

bool usable(std::span<const HandEyeObservation> observations, const HandEyeSolution& start) {
  const auto finite = [](const HandEyeObservation& o) {
    return o.poses.room_from_hand.matrix().allFinite() &&
           o.poses.eye_from_scene.matrix().allFinite() && o.hand_angular_velocity.allFinite() &&
           o.hand_velocity.allFinite();
  };
  return observations.size() >= kMinPoses &&
         std::all_of(observations.begin(), observations.end(), finite) &&
         start.hand_from_eye.matrix().allFinite() && std::isnormal(start.scale_units_per_mm) &&
         start.scale_units_per_mm > 0;
}

/// Huber's weight of one whitened residual.
double robust_weight(double norm, double huber) {
  return norm <= huber ? 1.0 : huber / norm;
}

/// The noise that explains the residuals, as far as they are not outliers.
ResidualNoise::Variances fit_noise(const std::vector<Vector6d>& residuals,
                                   const ResidualNoise& noise, Eigen::Index parameters,
                                   ResidualNoise::Variances variances,
                                   const MaximumLikelihoodOptions& options) {
  const ResidualNoise::Variances assumed = variances_of(options.noise);
  const auto n = static_cast<double>(residuals.size());
  const double freedom = n / (n - static_cast<double>(parameters) / 6.0);
  for (int iteration = 0; iteration < kWeightIterations; ++iteration) {
    const Matrix6d whitening = noise.whitening(variances);
    Matrix6d squares = Matrix6d::Zero();
    for (const Vector6d& r : residuals) {
      // The weight squared (Huber's proposal 2): an outlier counts no more than at the threshold.
      const double weight = robust_weight((whitening * r).norm(), options.huber);
      squares += weight * weight * r * r.transpose();
    }
    const Matrix6d mean_square =
        (kPriorPoses * noise.covariance(assumed) + freedom * squares) / (kPriorPoses + n);
    variances = noise.estimate(mean_square, variances);
  }
  return variances;
}

/// Inverse of the information; finite and huge along what was not observed.
Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * information *
                                                             scale.asDiagonal());
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(kLowestInformation).cwiseInverse();
  return scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
         eigen.eigenvectors().transpose() * scale.asDiagonal();
}

/// How many times fewer independent poses there are than poses: the integrated autocorrelation of
/// the whitened residuals, summed while it is above what chance shows. The unknowns act slowly
/// compared with it, so that the whole of it counts.
double correlation_time(const std::vector<Vector6d>& residuals, const Matrix6d& whitening) {
  std::vector<Vector6d> whitened;
  whitened.reserve(residuals.size());
  for (const Vector6d& r : residuals) {
    Vector6d w = whitening * r;
    const double norm = w.norm();
    if (norm > kLargestForCorrelation) w *= kLargestForCorrelation / norm;
    whitened.push_back(w);
  }
  double variance = 0;
  for (const Vector6d& w : whitened) variance += w.squaredNorm();
  const auto n = whitened.size();
  if (!(variance > 0)) return 1.0;
  const double chance = 2.5 / std::sqrt(6.0 * static_cast<double>(n));
  double sum = 1.0;
  for (std::size_t lag = 1; lag < n / 3; ++lag) {
    double product = 0;
    for (std::size_t k = lag; k < n; ++k) product += whitened[k].dot(whitened[k - lag]);
    const double correlation = product / variance;
    if (correlation < chance) break;
    sum += 2.0 * correlation;
  }
  return sum;
}

struct Estimate {
  MaximumLikelihoodResult result;
  double cost{0};             ///< Huber's, against the assumed noise: comparable between starts
  std::vector<double> norms;  ///< of the whitened residuals
};

Estimate estimate_from(std::span<const HandEyeObservation> observations,
                       const HandEyeSolution& start, const MaximumLikelihoodOptions& options) {
  PoseProblem problem(observations, start, options);
  const Eigen::Index p = problem.parameters();
  ResidualNoise::Variances variances = variances_of(options.noise);
  const int rounds = std::max(1, options.rounds);
  for (int round = 0; round < rounds; ++round) {
    problem.solve(
        ResidualNoise(problem.solution().hand_from_eye.translation()).whitening(variances));
    if (!options.estimate_noise) continue;
    const ResidualNoise noise(problem.solution().hand_from_eye.translation());
    variances = fit_noise(problem.residuals(), noise, p, variances, options);
  }

  const ResidualNoise noise(problem.solution().hand_from_eye.translation());
  const Matrix6d whitening = noise.whitening(variances);
  const Matrix6d assumed_whitening = noise.whitening(variances_of(options.noise));
  Eigen::MatrixXd jacobian = problem.jacobian(whitening);
  const std::vector<Vector6d> residuals = problem.residuals();
  Estimate estimate;
  double chi2 = 0;
  double assumed_chi2 = 0;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const double norm = (whitening * residuals[k]).norm();
    estimate.norms.push_back(norm);
    const double weight = robust_weight(norm, options.huber);
    jacobian.middleRows<6>(6 * static_cast<Eigen::Index>(k)) *= std::sqrt(weight);
    chi2 += weight * norm * norm;
    const double assumed = (assumed_whitening * residuals[k]).norm();
    assumed_chi2 += assumed * assumed;
    estimate.cost += assumed <= options.huber ? 0.5 * assumed * assumed
                                              : options.huber * (assumed - 0.5 * options.huber);
  }
  Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  if (options.estimate_scale) {
    information(12, 12) += 1.0 / (options.log_scale_prior * options.log_scale_prior);
  }
  if (options.estimate_time_offset) {
    information(p - 1, p - 1) += 1.0 / (options.time_offset_prior_s * options.time_offset_prior_s);
  }
  Eigen::MatrixXd covariance = inverse_information(information);

  MaximumLikelihoodResult& result = estimate.result;
  const double freedom =
      std::max(1.0, static_cast<double>(6 * residuals.size()) - static_cast<double>(p));
  result.chi2_per_dof = assumed_chi2 / freedom;
  if (!options.estimate_noise) {
    // Noise that was given is believed within what chance explains.
    const double chance = 1.0 + 3.3 * std::sqrt(2.0 / freedom);
    if (chi2 / freedom > chance) covariance *= chi2 / freedom;
  }
  if (options.account_for_correlation) {
    result.correlation_inflation = correlation_time(residuals, whitening);
    covariance *= result.correlation_inflation;
  }
  result.poses_used = observations.size();
  result.solution = problem.solution();
  result.room_from_scene = problem.room_from_scene();
  result.covariance = covariance.topLeftCorner<6, 6>();
  result.noise = noise_of(variances, options.noise);
  result.sigma_translation_known_scale_mm = result.sigma_translation_mm();
  if (options.estimate_scale) {
    result.log_scale_sigma = std::sqrt(covariance(12, 12));
    const double explained = covariance.block<3, 1>(3, 12).squaredNorm() / covariance(12, 12);
    result.sigma_translation_known_scale_mm =
        std::sqrt(std::max(0.0, covariance.block<3, 3>(3, 3).trace() - explained));
  }
  if (options.estimate_time_offset) {
    result.time_offset_correction_s = problem.time_offset_correction_s();
    result.time_offset_sigma_s = std::sqrt(covariance(p - 1, p - 1));
  }
  return estimate;
}

/// Huber's loss bounds an outlier's pull but keeps it; many that pull the same way would still bias
/// the answer. So what the noise cannot explain is left out, and the rest solved again.
MaximumLikelihoodResult estimate_without_outliers(std::span<const HandEyeObservation> observations,
                                                  const HandEyeSolution& start,
                                                  const MaximumLikelihoodOptions& options) {
  const Estimate all = estimate_from(observations, start, options);
  if (!(options.reject > 0)) return all.result;
  std::vector<HandEyeObservation> kept;
  kept.reserve(observations.size());
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (all.norms[k] <= options.reject) kept.push_back(observations[k]);
  }
  if (kept.size() == observations.size() || kept.size() < kMinPoses) return all.result;
  return estimate_from(kept, all.result.solution, options).result;
}

}  // namespace

double sigma_rotation_deg(const Matrix6d& covariance) {
  return deg_from_rad(std::sqrt(covariance.topLeftCorner<3, 3>().trace()));
}

double sigma_translation_mm(const Matrix6d& covariance) {
  return std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
}

double MaximumLikelihoodResult::sigma_rotation_deg() const {
  return handeye::sigma_rotation_deg(covariance);
}

double MaximumLikelihoodResult::sigma_translation_mm() const {
  return handeye::sigma_translation_mm(covariance);
}

std::optional<MaximumLikelihoodResult> maximum_likelihood(
    std::span<const HandEyeObservation> observations, const HandEyeSolution& start,
    const MaximumLikelihoodOptions& options) {
  if (!usable(observations, start)) return std::nullopt;
  return estimate_without_outliers(observations, start, options);
}

std::optional<MaximumLikelihoodResult> maximum_likelihood(
    std::span<const HandEyeObservation> observations, const MaximumLikelihoodOptions& options) {
  std::vector<PosePair> poses;
  poses.reserve(observations.size());
  for (const HandEyeObservation& observation : observations) poses.push_back(observation.poses);
  // With the assumed noise from every start; then the best, and its noise.
  MaximumLikelihoodOptions first = options;
  first.estimate_noise = false;
  first.rounds = 1;
  std::optional<Estimate> best;
  for (const HandEyeSolution& start : starting_solutions(poses)) {
    if (!usable(observations, start)) continue;
    const Estimate estimate = estimate_from(observations, start, first);
    if (!best || estimate.cost < best->cost) best = estimate;
  }
  if (!best) return std::nullopt;
  return estimate_without_outliers(observations, best->result.solution, options);
}

std::optional<HandEyeSolution> maximum_likelihood_unknown_scale(const HandEyeProblem& problem) {
  std::vector<HandEyeObservation> observations;
  observations.reserve(problem.poses.size());
  for (const PosePair& pair : problem.poses) observations.push_back({.poses = pair});
  const auto result = maximum_likelihood(
      observations, {.noise = problem.noise, .estimate_noise = problem.estimate_noise});
  if (!result) return std::nullopt;
  return result->solution;
}

}  // namespace handeye
