// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace handeye {
namespace {

/// Of chi2 with 1, 2, 3 degrees of freedom, passed by chance once in 10^6: half an hour has some
/// 10^3 looks, and it takes several in a row.
constexpr std::array<double, 4> kContradiction{0.0, 23.9, 27.6, 30.7};
/// Likewise with six: all of hand_from_eye held near the calibration, or free.
constexpr double kLeastGain = 38.3;

/// A deviation within the directions whose sigma is small enough.
struct Seen {
  double size{0};
  double sigma{0};
  double chi2{0};
  std::size_t directions{0};

  bool contradicts(double least, double lasting) const {
    return directions > 0 && size > least && chi2 > lasting * kContradiction[directions];
  }
};

Seen look_at(const Eigen::Vector3d& deviation, const Eigen::Matrix3d& covariance,
             double most_sigma) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  Seen seen;
  for (int i = 0; i < 3; ++i) {
    const double variance = eigen.eigenvalues()(i);
    if (!(variance < most_sigma * most_sigma)) continue;
    const double along = eigen.eigenvectors().col(i).dot(deviation);
    seen.size += along * along;
    seen.sigma += variance;
    seen.chi2 += along * along / variance;
    ++seen.directions;
  }
  seen.size = std::sqrt(seen.size);
  seen.sigma = std::sqrt(seen.sigma);
  return seen;
}

}  // namespace

WatchEvidence weigh(const WatchFit& fit, const Pose& hand_from_eye, const Matrix6d& covariance,
                    const WatchEvidenceOptions& options) {
  const Matrix6d both = fit.covariance + covariance;
  const Seen turn =
      look_at(log_so3(fit.hand_from_eye.linear() * hand_from_eye.linear().transpose()),
              both.topLeftCorner<3, 3>(), rad_from_deg(options.seen_deg));
  WatchEvidence evidence;
  evidence.deviation_deg = deg_from_rad(turn.size);
  evidence.sigma_deg = deg_from_rad(turn.sigma);
  evidence.measured = turn.directions > 0;
  if (!fit.converged || !explains(fit)) return evidence;
  const double least_rad = rad_from_deg(options.turned_deg);
  if (turn.contradicts(least_rad, 1.0)) {
    const bool beyond_doubt = turn.contradicts(least_rad, fit.lasting) && fit.gain > kLeastGain;
    if (beyond_doubt) evidence.kind = WatchEvidence::Kind::kContradicts;
  } else if (turn.directions == 3) {
    evidence.kind = WatchEvidence::Kind::kAgrees;
  }
  return evidence;
}

}  // namespace handeye
