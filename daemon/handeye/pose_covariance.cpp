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
PartedMatrix hessian(const PoseProblem& problem, const PartNoise& noise,
                     const PartedMatrix& information) {
  const Eigen::Index size = information.rows();
  PartedMatrix result = PartedMatrix::Identity(size, size);
  const auto differentiate = [&](int unknown, std::size_t part) {
    if (!problem.estimates(unknown, part)) return;
    const Eigen::Index i = index_of(unknown, part);
    PartedVector step = PartedVector::Zero(size);
    step[i] = std::min(kDifferenceStep / std::sqrt(std::max(information(i, i), 1e-300)),
                       longest_step(unknown));
    const PartedVector ahead = problem.gradient(noise, problem.unknowns().moved_by(step));
    const PartedVector behind = problem.gradient(noise, problem.unknowns().moved_by(-step));
    result.col(i) = (ahead - behind) / (2.0 * step[i]);
  };
  for (int unknown = 0; unknown < kUnknowns; ++unknown) {
    const std::size_t parts = is_common(unknown) ? 1 : problem.parts().size();
    for (std::size_t part = 0; part < parts; ++part) differentiate(unknown, part);
  }
  return 0.5 * (result + result.transpose());
}

/// The inverse of a symmetric matrix, finite along what is not observed. By its type of fixed size
/// where there is one part.
template <typename Matrix>
Matrix limited_inverse(const PartedMatrix& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen((Matrix(symmetric)));
  return eigen.eigenvectors() *
         eigen.eigenvalues().cwiseMax(kLowestInformation).cwiseInverse().asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// A scale's variance brought down to what it can be at most, and with it what it explains.
void limit_scale(PartedMatrix& covariance, Eigen::Index scale) {
  const double variance = covariance(scale, scale);
  const double most = kLargestLogScaleSigma * kLargestLogScaleSigma;
  if (!(variance > most)) return;
  const PartedVector column = covariance.col(scale);
  covariance -= (1.0 - most / variance) / variance * column * column.transpose();
}

}  // namespace

double share_sigma(bool noise_estimated) {
  return noise_estimated ? kShareSigma : kShareSigmaOfGivenNoise;
}

PartedVector gradient_by_share(const PoseProblem& problem, PartNoise noise) {
  const double share = noise.front().eye_share;
  const double more = std::min(share + kShareStep, 1.0);
  const double less = std::max(share - kShareStep, 0.0);
  const auto gradient_at = [&](double eye_share) {
    for (ResidualNoise::Variances& of_part : noise) of_part.eye_share = eye_share;
    return problem.gradient(noise, problem.unknowns());
  };
  const PartedVector ahead = gradient_at(more);
  return (ahead - gradient_at(less)) / (more - less);
}

void widen_scale(PartedMatrix& covariance, Eigen::Index scale, double log_scale_sigma) {
  const double variance = covariance(scale, scale);
  const double wanted = log_scale_sigma * log_scale_sigma;
  if (!(variance > 0) || !(wanted > variance)) return;
  const PartedVector column = covariance.col(scale);
  covariance += (wanted / variance - 1.0) / variance * column * column.transpose();
}

PartedMatrix covariance_of_unknowns(const PoseProblem& problem, const PartNoise& noise,
                                    bool noise_estimated) {
  const PartedMatrix information = problem.normal_equations(noise, problem.unknowns()).information;
  const PartedVector unit = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const auto scaled = [&](const PartedMatrix& matrix) -> PartedMatrix {
    return unit.asDiagonal() * matrix * unit.asDiagonal();
  };
  const PartedMatrix curvature = scaled(hessian(problem, noise, information));
  const PartedMatrix inverse = curvature.rows() == kUnknowns
                                   ? PartedMatrix(limited_inverse<UnknownsMatrix>(curvature))
                                   : limited_inverse<PartedMatrix>(curvature);
  PartedMatrix meat = scaled(information);
  meat.diagonal().array() += kLowestInformation;  // where both are blind, H decides
  PartedMatrix covariance = inverse * meat * inverse;
  const PartedVector shift =
      share_sigma(noise_estimated) * inverse * unit.cwiseProduct(gradient_by_share(problem, noise));
  covariance += shift * shift.transpose();
  covariance = scaled(covariance);
  for (std::size_t part = 0; part < problem.parts().size(); ++part) {
    limit_scale(covariance, index_of(kLogScale, part));
  }
  return covariance;
}

double correlation_time(const std::vector<std::vector<Vector6d>>& whitened_of_parts) {
  std::vector<std::vector<Vector6d>> series = whitened_of_parts;
  double variance = 0;
  std::size_t n = 0;
  std::size_t longest = 0;
  for (std::vector<Vector6d>& of_part : series) {
    for (Vector6d& w : of_part) {
      const double norm = w.norm();
      if (norm > kLargestForCorrelation) w *= kLargestForCorrelation / norm;
      variance += w.squaredNorm();
    }
    n += of_part.size();
    longest = std::max(longest, of_part.size());
  }
  if (!(variance > 0)) return 1.0;
  const double chance = 2.5 / std::sqrt(6.0 * static_cast<double>(n));
  double sum = 1.0;
  for (std::size_t lag = 1; lag < longest / 3; ++lag) {
    double product = 0;
    for (const std::vector<Vector6d>& w : series) {
      for (std::size_t k = lag; k < w.size(); ++k) product += w[k].dot(w[k - lag]);
    }
    const double correlation = product / variance;
    if (correlation < chance) break;
    sum += 2.0 * correlation;
  }
  return sum;
}

}  // namespace handeye
