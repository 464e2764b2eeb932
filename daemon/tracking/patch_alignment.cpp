// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/patch_alignment.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace handeye {
namespace {

using Index = PatchBasis::Index;

constexpr int kMaxIterations = 12;
constexpr int kMaxShiftIterations = 10;
constexpr float kConverged = 0.005F;      ///< px, of the patch's corners
constexpr float kShiftConverged = 0.03F;  ///< px of the level
constexpr float kFarthestShift = 10.0F;   ///< px of the level, from the start
/// The light may change by so much and no more; darker or brighter, it is another picture.
constexpr double kLeastGain = 0.2;
constexpr double kMostGain = 5.0;
/// A patch of which less may be looked at is given up.
constexpr float kLeastShare = 0.5F;
/// A patch's grey value is known no better than this, whatever the residuals say [grey levels].
constexpr double kLeastNoise = 0.5 * ImagePyramid::kUnitsPerGrey;
/// A texture that leaves the position less sure than this at the least noise [px].
constexpr double kWeakestSigma = 0.15;
constexpr float kSameMaskPx = 0.2F;  ///< a start that near saw the same of the mask
constexpr float kLargestStretch = 3.0F;

PatchFit judge(double energy, double explained, double signal, double sigma_per_noise,
               double pixels, double gain) {
  const double residual = std::max(energy - explained, 0.0);
  PatchFit fit;
  fit.found = true;
  fit.correlation = static_cast<float>(std::sqrt(signal / std::max(signal + residual, 1e-9)));
  const double noise = std::max(std::sqrt(residual / std::max(pixels - 10.0, 1.0)), kLeastNoise);
  fit.sigma_px = static_cast<float>(noise * sigma_per_noise / gain);
  return fit;
}

/// Position's standard deviation [px] per unit of noise, from the inverse of a normal matrix.
template <typename Matrix>
double sigma_per_noise(const Matrix& inverse) {
  return std::sqrt(std::max(inverse(0, 0) + inverse(1, 1), 0.0));
}

template <typename Matrix>
bool invert(const Matrix& matrix, Matrix& inverse) {
  const Eigen::LDLT<Matrix> factors(matrix);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return false;
  const auto pivots = factors.vectorD();
  if (pivots.minCoeff() < 1e-9 * pivots.maxCoeff()) return false;
  inverse = factors.solve(Matrix::Identity());
  return inverse.allFinite();
}

}  // namespace

bool Appearance::take(const ImagePyramid& pyramid, int x, int y) {
  basis_.take(pyramid.grey(0), x, y);
  const PatchBasis::Matrix normal = normal_matrix(basis_, whole_patch());
  contrast_ = normal(Index::kGain, Index::kGain);
  return invert(normal, inverse_) && kLeastNoise * sigma_per_noise(inverse_) < kWeakestSigma;
}

PatchFit Appearance::align(const ImagePyramid& pyramid, AffineWarp& warp) const {
  const AffineWarp start = warp;
  const PatchFit fit = align_from(pyramid, warp);
  if (!fit.found || (warp.centre - start.centre).norm() < kSameMaskPx) return fit;
  // What may be looked at was asked where the patch was looked for, not where it is.
  Patch weights;
  const bool whole = usable_share(pyramid, 0, start, weights) >= 1.0F &&
                     usable_share(pyramid, 0, warp, weights) >= 1.0F;
  return whole ? fit : align_from(pyramid, warp);
}

PatchFit Appearance::align_from(const ImagePyramid& pyramid, AffineWarp& warp) const {
  Patch weights;
  const float share = usable_share(pyramid, 0, warp, weights);
  if (share < kLeastShare) return {};
  const bool whole = share >= 1.0F;
  PatchBasis weighed;
  PatchBasis::Matrix weighed_inverse;
  double contrast = contrast_;
  if (!whole) {
    weighed = basis_;
    weighed.weigh(weights);
    const PatchBasis::Matrix normal = normal_matrix(weighed, weights);
    contrast = normal(Index::kGain, Index::kGain);
    if (!invert(normal, weighed_inverse)) return {};
  }
  const PatchBasis& basis = whole ? basis_ : weighed;
  const PatchBasis::Matrix& inverse = whole ? inverse_ : weighed_inverse;
  const Patch& weight = whole ? whole_patch() : weights;

  Patch image;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!sample(pyramid.grey(0), warp, image)) return {};
    const PatchProducts sums = products(image, basis, weight);
    const PatchBasis::Vector change = inverse * sums.with_basis;
    const double gain = change[Index::kGain];
    if (!(gain > kLeastGain && gain < kMostGain)) return {};
    const PatchBasis::Vector step = change / gain;
    // The warp that the patch would have to undergo; the image's is its inverse's.
    constexpr double kPerPx = 1.0 / Patch::kRadius;
    Eigen::Matrix2d linear;
    linear << 1.0 + kPerPx * step[Index::kUDx], kPerPx * step[Index::kVDx],
        kPerPx * step[Index::kUDy], 1.0 + kPerPx * step[Index::kVDy];
    if (linear.determinant() < 0.25) return {};
    warp.linear = (warp.linear.cast<double>() * linear.inverse()).cast<float>();
    warp.centre -= warp.linear * step.head<2>().cast<float>();
    if (!warp.linear.allFinite() || warp.linear.cwiseAbs().maxCoeff() > kLargestStretch) return {};
    const double moved = step.head<2>().norm() + step.segment<4>(Index::kUDx).norm();
    if (moved < kConverged || iteration + 1 == kMaxIterations) {
      if (moved > 10 * kConverged) return {};
      return judge(sums.with_itself, sums.with_basis.dot(change), gain * gain * contrast,
                   sigma_per_noise(inverse), share * Patch::kPixels, gain);
    }
  }
  return {};
}

PatchFit align_shift(const ImagePyramid& before, const ImagePyramid& now, int level,
                     const Eigen::Vector2f& position, Eigen::Vector2f& found) {
  const auto x = static_cast<int>(std::lround(position.x()));
  const auto y = static_cast<int>(std::lround(position.y()));
  const Eigen::Vector2f offset =
      position - Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
  constexpr int kReach = Patch::kRadius + 1;
  if (!before.grey(level).holds(x - kReach, y - kReach, x - kReach + Patch::kStride + 1,
                                y + kReach)) {
    return {};
  }
  const Eigen::Vector2f there(static_cast<float>(x), static_cast<float>(y));
  const Eigen::Vector2f here = found - offset;
  Patch weights_there;
  Patch weights_here;
  const float share_there = usable_share(before, level, there, weights_there);
  const float share_here = usable_share(now, level, here, weights_here);
  if (share_there + share_here < 1.0F + kLeastShare) return {};
  PatchBasis basis;
  basis.take(before.grey(level), x, y);
  const bool whole = share_there >= 1.0F && share_here >= 1.0F;
  if (!whole) {
    if (share_there >= 1.0F) weights_there = whole_patch();
    if (share_here >= 1.0F) weights_here = whole_patch();
    for (std::size_t i = 0; i < weights_here.value.size(); ++i) {
      weights_here.value[i] *= weights_there.value[i];
    }
    basis.weigh(weights_here);
  }
  const Patch& weight = whole ? whole_patch() : weights_here;
  const PatchBasis::ShiftMatrix normal = shift_normal_matrix(basis, weight);
  PatchBasis::ShiftMatrix inverse;
  if (!invert(normal, inverse)) return {};
  const double sigma = sigma_per_noise(inverse);
  if (kLeastNoise * sigma > kWeakestSigma) return {};

  Eigen::Vector2f centre = here;
  Patch image;
  for (int iteration = 0; iteration < kMaxShiftIterations; ++iteration) {
    if (!sample(now.grey(level), centre, image)) return {};
    const PatchProducts sums = products(image, basis, weight);
    PatchBasis::ShiftVector with_basis;
    with_basis << sums.with_basis.head<2>(), sums.with_basis.tail<4>();
    const PatchBasis::ShiftVector change = inverse * with_basis;
    const double gain = change[2];
    if (!(gain > kLeastGain && gain < kMostGain)) return {};
    const Eigen::Vector2f step = (change.head<2>() / gain).cast<float>();
    centre -= step;
    if ((centre - here).norm() > kFarthestShift) return {};
    if (step.norm() < kShiftConverged || iteration + 1 == kMaxShiftIterations) {
      found = centre + offset;
      return judge(sums.with_itself, with_basis.dot(change), gain * gain * normal(2, 2), sigma,
                   normal(3, 3), gain);
    }
  }
  return {};
}

}  // namespace handeye
