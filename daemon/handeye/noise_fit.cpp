// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/noise_fit.hpp"

#include <cmath>

namespace handeye {
namespace {

constexpr double kPriorPoses = 1;    // so many poses' worth is the assumed noise
constexpr int kMostIterations = 30;  // of noise and robust weights
constexpr double kSettled = 1e-4;    // relative change of every variance

bool settled(const ResidualNoise::Variances& a, const ResidualNoise::Variances& b) {
  const auto near = [](double x, double y) { return std::abs(x - y) <= kSettled * y; };
  return near(a.hand_rotation, b.hand_rotation) && near(a.eye_rotation, b.eye_rotation) &&
         near(a.translation, b.translation);
}

}  // namespace

ResidualNoise::Variances fit_noise(const std::vector<Vector6d>& residuals,
                                   const ResidualNoise& noise, double parameters, double huber,
                                   const ResidualNoise::Variances& assumed,
                                   const ResidualNoise::Variances& start) {
  const auto n = static_cast<double>(residuals.size());
  if (!(6.0 * n > parameters)) return start;  // residuals say nothing
  const double freedom = n / (n - parameters / 6.0);
  const Matrix6d prior = kPriorPoses * noise.covariance(assumed);
  ResidualNoise::Variances variances = start;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Matrix6d whitening = noise.whitening(variances);
    Matrix6d squares = Matrix6d::Zero();
    for (const Vector6d& r : residuals) {
      const double norm = (whitening * r).norm();
      const double weight = norm <= huber ? 1.0 : huber / norm;
      squares.noalias() += (weight * weight * r) * r.transpose();
    }
    const ResidualNoise::Variances next =
        noise.estimate((prior + freedom * squares) / (kPriorPoses + n), variances);
    const bool done = settled(next, variances);
    variances = next;
    if (done) break;
  }
  return variances;
}

}  // namespace handeye
