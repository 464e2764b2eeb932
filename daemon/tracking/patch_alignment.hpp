// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "daemon/tracking/patch_basis.hpp"

namespace handeye {

/// How well a patch was found again.
struct PatchFit {
  bool found{false};     ///< converged within the image, conditioned and with a credible gain
  float correlation{0};  ///< of the image with the patch, gain and offset taken out; 1 = the same
  float sigma_px{0};     ///< standard deviation of the position that the residuals suggest
};

/// A patch that is looked for by an affine change of its shape and of its light: what a feature
/// looked like when it was first seen. Inverse compositional (Baker, Matthews 2004): everything
/// that depends on the patch alone is computed here, once.
class Appearance {
 public:
  /// From the pyramid's level 0, around a pixel whose patch may be looked at as a whole. False
  /// where the patch has too little texture to be located.
  bool take(const ImagePyramid& pyramid, int x, int y);

  /// Minimises sum_patch (I(W(p)) - gain T(p) - offset - ramp . p)^2 over the warp W and the light,
  /// from a warp some pixels off.
  PatchFit align(const ImagePyramid& pyramid, AffineWarp& warp) const;

 private:
  PatchFit align_from(const ImagePyramid& pyramid, AffineWarp& warp) const;

  PatchBasis basis_;
  PatchBasis::Matrix inverse_;  ///< of the normal matrix
  double contrast_{0};          ///< sum of the squares of its grey values
};

/// Moves `found`, the start on a level of `now`, to where the patch around `position` on the same
/// level of `before` is. Both in the level's own px.
PatchFit align_shift(const ImagePyramid& before, const ImagePyramid& now, int level,
                     const Eigen::Vector2f& position, Eigen::Vector2f& found);

}  // namespace handeye
