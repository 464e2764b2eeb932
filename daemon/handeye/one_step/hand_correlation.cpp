// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/hand_correlation.hpp"

#include <cmath>

namespace handeye {
namespace {

constexpr double kChance = 2.5;  // standard deviations of a correlation

}  // namespace

bool share_samples(const HandAtFrame& earlier, const HandAtFrame& later) {
  return later.sample < earlier.sample + static_cast<std::int64_t>(earlier.shares.size());
}

double shared_variance(const HandAtFrame& first, const HandAtFrame& second) {
  const HandAtFrame& early = first.sample <= second.sample ? first : second;
  const HandAtFrame& late = first.sample <= second.sample ? second : first;
  const auto later_by = static_cast<std::size_t>(late.sample - early.sample);
  double shared = 0;
  for (std::size_t i = 0; i < late.shares.size() && later_by + i < early.shares.size(); ++i) {
    shared += early.shares[later_by + i] * late.shares[i];
  }
  return shared;
}

Matrix6d shared_covariance(const MetricProblem& problem, const HandRow& first,
                           const HandRow& second) {
  const HandAtFrame& one = *problem.scene().frames[first.frame].hand;
  const HandAtFrame& other = *problem.scene().frames[second.frame].hand;
  const double shared = shared_variance(one, other);
  if (shared == 0) return Matrix6d::Zero();
  const bool measured = problem.options().hand_noise == HandNoiseSource::kMeasured;
  const Matrix6d sample = 0.5 * (sample_covariance(one, problem.noise(), measured) +
                                 sample_covariance(other, problem.noise(), measured));
  const std::vector<Matrix6d>& whitenings = problem.hands().weights.whitenings;
  return shared * whitenings[first.frame] * sample * whitenings[second.frame].transpose();
}

double correlation_beyond_samples(const MetricProblem& problem) {
  const std::vector<HandRow>& rows = problem.hand_rows();
  const std::vector<MetricFrame>& frames = problem.scene().frames;
  double variance = 0;
  for (const HandRow& row : rows) variance += row.residual.squaredNorm();
  if (!(variance > 0)) return 1.0;
  const double chance = kChance / std::sqrt(6.0 * static_cast<double>(rows.size()));
  double sum = 1.0;
  for (std::size_t lag = 1; lag < rows.size() / 3; ++lag) {
    double product = 0;
    for (std::size_t k = lag; k < rows.size(); ++k) {
      if (frames[rows[k].frame].part != frames[rows[k - lag].frame].part) continue;
      product += rows[k].residual.dot(rows[k - lag].residual) -
                 shared_covariance(problem, rows[k - lag], rows[k]).trace();
    }
    const double correlation = product / variance;
    if (correlation < chance) break;
    sum += 2.0 * correlation;
  }
  return sum;
}

}  // namespace handeye
