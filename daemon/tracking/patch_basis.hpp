// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include "daemon/tracking/patch.hpp"

namespace handeye {

/// What a patch can change into, to first order: its derivatives along x and y (times 1, u, v for
/// an affine change), itself (gain), a constant (offset) and two ramps (light that falls off across
/// the patch and does not move with it). u, v are patch coordinates over the radius, in [-1, 1].
///
/// All sums over the patch reduce to three images and the weights' geometry, so the ten basis
/// images are never formed.
struct PatchBasis {
  /// Order of the basis images in vectors and matrices.
  enum Index { kDx, kDy, kUDx, kVDx, kUDy, kVDy, kGain, kOffset, kRampU, kRampV, kCount };
  using Vector = Eigen::Matrix<double, kCount, 1>;
  using Matrix = Eigen::Matrix<double, kCount, kCount>;
  /// Without the affine change: kDx, kDy, then kGain to kRampV.
  using ShiftVector = Eigen::Matrix<double, 6, 1>;
  using ShiftMatrix = Eigen::Matrix<double, 6, 6>;

  Patch grey;    ///< less its mean over the pixels that count
  Patch dx, dy;  ///< per px

  /// Takes the patch around a pixel, the derivatives by central differences. The patch and a pixel
  /// around it must lie within the padding.
  void take(const PaddedPlane<std::int16_t>& image, int x, int y);

  /// Takes out the pixels whose weight is 0, and of the others' grey values their own mean: what is
  /// under a mask has no say in how much contrast the rest has.
  void weigh(const Patch& weights);
};

/// Inner products of an image patch (less its weighted mean) with the basis images, which must
/// have been weighed alike, and with itself.
struct PatchProducts {
  PatchBasis::Vector with_basis;
  double with_itself{0};
};
PatchProducts products(const Patch& image, const PatchBasis& basis, const Patch& weights);

/// Inner products of the basis images with each other.
PatchBasis::Matrix normal_matrix(const PatchBasis& basis, const Patch& weights);
PatchBasis::ShiftMatrix shift_normal_matrix(const PatchBasis& basis, const Patch& weights);

}  // namespace handeye
