// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/scale_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "daemon/handeye/pose_covariance.hpp"

namespace handeye {
namespace {

constexpr std::array<double, 5> kDistances{0.1, 0.2, 0.4, 0.8, 1.6};  // of log scale
constexpr double kShareSigmas = 2.0;
constexpr double kLeastShare = 0.02;
constexpr double kLeastVariance = 1e-12;
constexpr double kRejected = 3.3;  // standard deviations of the gradient: once in a thousand

/// The gradient by the log scale at `scale`, the other unknowns at their best for it, in its own
/// standard deviations. The prior has no say in it.
double score_of_scale(const PoseProblem& problem, Eigen::Index scale, const PartNoise& noise,
                      double log_scale_prior, double inflation) {
  const auto equations = problem.normal_equations(noise, problem.unknowns());
  const Eigen::Index size = equations.gradient.size();
  const PartedMatrix inverse =
      equations.information.ldlt().solve(PartedMatrix::Identity(size, size));
  const double information = 1.0 / inverse(scale, scale);
  const double gradient = information * dot(inverse.row(scale), equations.gradient);
  const double variance = information - 1.0 / (log_scale_prior * log_scale_prior);
  return gradient / std::sqrt(inflation * std::max(variance, kLeastVariance));
}

/// Whatever the eye's share in the translation noise may be.
bool rejects(PoseProblem problem, std::size_t part, double log_scale,
             const MaximumLikelihoodOptions& options, const PartNoise& noise, double inflation) {
  problem.hold_scale(part, log_scale);
  problem.minimise(noise);
  problem.free_scale();
  const double reach = kShareSigmas * share_sigma(options.estimate_noise);
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const double step : {-reach, 0.0, reach}) {
    PartNoise assumed = noise;
    for (ResidualNoise::Variances& of_part : assumed) {
      of_part.eye_share = std::clamp(of_part.eye_share + step, kLeastShare, 1.0 - kLeastShare);
    }
    const double score = score_of_scale(problem, index_of(kLogScale, part), assumed,
                                        options.log_scale_prior, inflation);
    lowest = std::min(lowest, score);
    highest = std::max(highest, score);
  }
  return lowest > kRejected || highest < -kRejected;
}

}  // namespace

double undecided_log_scale(const PoseProblem& solved, std::size_t part,
                           const MaximumLikelihoodOptions& options, const PartNoise& noise,
                           double inflation) {
  const double found = solved.unknowns().of(part).log_scale;
  double farthest = 0;
  for (const double distance : kDistances) {
    for (const double log_scale : {found - distance, found + distance}) {
      if (!rejects(solved, part, log_scale, options, noise, inflation)) farthest = distance;
    }
  }
  return farthest;
}

}  // namespace handeye
