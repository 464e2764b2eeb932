// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/pose_covariance.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr double kLowestInformation = 1e-13;  // of scaled equations: beyond it, not observed
constexpr double kDifferenceStep = 1e-2;      // in standard deviations were all else known
constexpr double kLongestStep_rad = 1e-4;     // however little is known
constexpr double kLongestStep_mm = 1e-2;
constexpr double kShareSigma = 0.25;  // of the eye's share in the translation noise: any share
constexpr double kShareSigmaOfGivenNoise = 0.1;
constexpr double kShareStep = 0.05;
constexpr double kLargestLogScaleSigma = 2.0;   // the start is never wrong by more than e^2 or so
constexpr double kLargestForCorrelation = 6.0;  // norm to which outliers are cut

double longest_step(int index) {
  const bool length =
      (index >= kEyeShift && index < kSceneTurn) || (index >= kSceneShift && index < kLogScale);
  return length ? kLongestStep_mm : kLongestStep_rad;
}

/// Central differences of the gradient.
UnknownsMatrix hessian(const PoseProblem& problem, const ResidualNoise::Variances& noise,
                       const UnknownsMatrix& information) {
  UnknownsMatrix result = UnknownsMatrix::Identity();
  for (int i = 0; i < kUnknowns; ++i) {
    if (!problem.estimates(i)) continue;
    UnknownsVector step = UnknownsVector::Zero();
    step[i] =
        std::min(kDifferenceStep / std::sqrt(std::max(information(i, i), 1e-300)), longest_step(i));
    const UnknownsVector ahead = problem.gradient(noise, problem.unknowns().moved_by(step));
    const UnknownsVector behind = problem.gradient(noise, problem.unknowns().moved_by(-step));
    result.col(i) = (ahead - behind) / (2.0 * step[i]);
  }
  return 0.5 * (result + result.transpose());
}

/// The scale's variance brought down to what it can be at most, and with it what it explains.
void limit_scale(UnknownsMatrix& covariance) {
  const double variance = covariance(kLogScale, kLogScale);
  const double most = kLargestLogScaleSigma * kLargestLogScaleSigma;
  if (!(variance > most)) return;
  const UnknownsVector column = covariance.col(kLogScale);
  covariance -= (1.0 - most / variance) / variance * column * column.transpose();
}

}  // namespace

double share_sigma(bool noise_estimated) {
  return noise_estimated ? kShareSigma : kShareSigmaOfGivenNoise;
}

UnknownsVector gradient_by_share(const PoseProblem& problem, ResidualNoise::Variances noise) {
  const double share = noise.eye_share;
  const double more = std::min(share + kShareStep, 1.0);
  const double less = std::max(share - kShareStep, 0.0);
  noise.eye_share = more;
  const UnknownsVector ahead = problem.gradient(noise, problem.unknowns());
  noise.eye_share = less;
  const UnknownsVector behind = problem.gradient(noise, problem.unknowns());
  return (ahead - behind) / (more - less);
}

void widen_scale(UnknownsMatrix& covariance, double log_scale_sigma) {
  const double variance = covariance(kLogScale, kLogScale);
  const double wanted = log_scale_sigma * log_scale_sigma;
  if (!(variance > 0) || !(wanted > variance)) return;
  const UnknownsVector column = covariance.col(kLogScale);
  covariance += (wanted / variance - 1.0) / variance * column * column.transpose();
}

UnknownsMatrix covariance_of_unknowns(const PoseProblem& problem,
                                      const ResidualNoise::Variances& noise, bool noise_estimated) {
  const UnknownsMatrix information =
      problem.normal_equations(noise, problem.unknowns()).information;
  const UnknownsVector unit = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const auto scaled = [&](const UnknownsMatrix& matrix) -> UnknownsMatrix {
    return unit.asDiagonal() * matrix * unit.asDiagonal();
  };
  const Eigen::SelfAdjointEigenSolver<UnknownsMatrix> eigen(
      scaled(hessian(problem, noise, information)));
  const UnknownsMatrix inverse =
      eigen.eigenvectors() *
      eigen.eigenvalues().cwiseMax(kLowestInformation).cwiseInverse().asDiagonal() *
      eigen.eigenvectors().transpose();
  UnknownsMatrix meat = scaled(information);
  meat.diagonal().array() += kLowestInformation;  // where both are blind, H decides
  UnknownsMatrix covariance = inverse * meat * inverse;
  const UnknownsVector shift =
      share_sigma(noise_estimated) * inverse * unit.cwiseProduct(gradient_by_share(problem, noise));
  covariance += shift * shift.transpose();
  covariance = scaled(covariance);
  limit_scale(covariance);
  return covariance;
}

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

}  // namespace handeye
