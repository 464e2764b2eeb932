// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_consensus.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// With 40 % of the tracks wrong a sample of four is clean in 13 % of cases: one of 60 is, but for
/// once in 4000.
constexpr int kSamples = 60;
constexpr std::size_t kRefined = 4;
constexpr int kRefinements = 6;
/// Share of the tracks over which the residuals are kept small.
constexpr double kMajority = 0.55;
/// Tracks within this multiple of the majority's largest residual belong.
constexpr double kWidth = 2.5;

/// centre + span(basis), of the columns' space.
struct AffineSubspace {
  Eigen::VectorXd centre;
  Eigen::MatrixXd basis;  ///< orthonormal, three columns
};

struct Fit {
  AffineSubspace subspace;
  double trimmed{std::numeric_limits<double>::infinity()};  ///< sum of the majority's squares
};

using Columns = std::vector<Eigen::Index>;

Eigen::MatrixXd gather(const Eigen::MatrixXd& rays, const Columns& columns) {
  Eigen::MatrixXd gathered(rays.rows(), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index i = 0; i < gathered.cols(); ++i) {
    gathered.col(i) = rays.col(columns[static_cast<std::size_t>(i)]);
  }
  return gathered;
}

AffineSubspace through_sample(const Eigen::MatrixXd& rays, std::mt19937& random) {
  Columns sample;
  while (sample.size() < 4) {
    const auto column =
        static_cast<Eigen::Index>(random() % static_cast<std::uint32_t>(rays.cols()));
    if (std::find(sample.begin(), sample.end(), column) == sample.end()) sample.push_back(column);
  }
  const Eigen::MatrixXd four = gather(rays, sample);
  AffineSubspace subspace;
  subspace.centre = four.rowwise().mean();
  const Eigen::MatrixXd directions = four.rightCols<3>().colwise() - four.col(0);
  subspace.basis = Eigen::HouseholderQR<Eigen::MatrixXd>(directions).householderQ() *
                   Eigen::MatrixXd::Identity(rays.rows(), 3);
  return subspace;
}

AffineSubspace best_through(const Eigen::MatrixXd& rays, const Columns& columns) {
  Eigen::MatrixXd chosen = gather(rays, columns);
  AffineSubspace subspace;
  subspace.centre = chosen.rowwise().mean();
  chosen.colwise() -= subspace.centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(chosen * chosen.transpose());
  subspace.basis = eigen.eigenvectors().rightCols<3>();
  return subspace;
}

Eigen::VectorXd squared_residuals(const Eigen::MatrixXd& rays, const AffineSubspace& subspace) {
  const Eigen::MatrixXd centred = rays.colwise() - subspace.centre;
  const Eigen::MatrixXd inside = subspace.basis.transpose() * centred;
  return (centred.colwise().squaredNorm() - inside.colwise().squaredNorm()).cwiseMax(0.0);
}

/// The columns with the smallest residuals, as many as the majority has; ties by position.
Columns smallest(const Eigen::VectorXd& squared, std::size_t majority) {
  Columns columns(static_cast<std::size_t>(squared.size()));
  std::iota(columns.begin(), columns.end(), Eigen::Index{0});
  std::nth_element(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(majority - 1),
                   columns.end(), [&](Eigen::Index a, Eigen::Index b) {
                     return squared(a) != squared(b) ? squared(a) < squared(b) : a < b;
                   });
  columns.resize(majority);
  std::sort(columns.begin(), columns.end());
  return columns;
}

double sum_over(const Eigen::VectorXd& squared, const Columns& columns) {
  return std::accumulate(columns.begin(), columns.end(), 0.0,
                         [&](double sum, Eigen::Index column) { return sum + squared(column); });
}

/// Concentration: fit to the majority, take the majority anew.
Fit refine(const Eigen::MatrixXd& rays, Fit fit, std::size_t majority) {
  for (int i = 0; i < kRefinements; ++i) {
    const Columns columns = smallest(squared_residuals(rays, fit.subspace), majority);
    Fit next{best_through(rays, columns), 0.0};
    const Eigen::VectorXd squared = squared_residuals(rays, next.subspace);
    next.trimmed = sum_over(squared, smallest(squared, majority));
    const bool settled = !(next.trimmed < (1.0 - 1e-6) * fit.trimmed);
    if (next.trimmed < fit.trimmed) fit = std::move(next);
    if (settled) break;
  }
  return fit;
}

}  // namespace

std::vector<Eigen::Index> consistent_tracks(const Eigen::MatrixXd& rays, double noise) {
  const auto count = static_cast<std::size_t>(rays.cols());
  if (count < 8) return {};
  const auto majority = static_cast<std::size_t>(std::ceil(kMajority * static_cast<double>(count)));
  std::mt19937 random(1);
  std::vector<Fit> fits;
  for (int i = 0; i < kSamples; ++i) {
    Fit fit{through_sample(rays, random), 0.0};
    const Eigen::VectorXd squared = squared_residuals(rays, fit.subspace);
    fit.trimmed = sum_over(squared, smallest(squared, majority));
    fits.push_back(std::move(fit));
  }
  const auto better = [](const Fit& a, const Fit& b) { return a.trimmed < b.trimmed; };
  std::stable_sort(fits.begin(), fits.end(), better);
  fits.resize(kRefined);
  for (Fit& fit : fits) fit = refine(rays, std::move(fit), majority);
  const Fit& best = *std::min_element(fits.begin(), fits.end(), better);

  const Eigen::VectorXd squared = squared_residuals(rays, best.subspace);
  double largest = 0.0;
  for (const Eigen::Index column : smallest(squared, majority)) {
    largest = std::max(largest, squared(column));
  }
  const double limit =
      std::max(kWidth * kWidth * largest, noise * noise * static_cast<double>(rays.rows()));
  Columns consistent;
  for (Eigen::Index column = 0; column < rays.cols(); ++column) {
    if (squared(column) <= limit) consistent.push_back(column);
  }
  return consistent;
}

}  // namespace handeye
