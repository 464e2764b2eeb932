// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Cholesky>

#include "daemon/handeye/one_step/point_elimination.hpp"

namespace handeye {

/// A keyframe by sight: the pose that its images alone give it, the points and the lens as they
/// are. A keyframe's own pose answers to its own tracker sample as well; one by sight moves as the
/// structure under it does, and that is how a frame moves which was resected against the structure.

/// room_from_eye of every keyframe by sight: a Gauss-Newton step of resection from where it is.
std::vector<Pose> keyframes_by_sight(const MetricScene& scene, const MetricState& state,
                                     const ImageRows& rows);

/// The images' equations [px^2] over keyframes by sight, y, instead of keyframes, x. Eliminating
/// the points leaves the information S on x and the lens l. With U, block-diagonal, that of x where
/// the points are fixed, the points make y = (I - U^-1 S) x - U^-1 S_xl l + noise of covariance
/// U^-1 (U - S) U^-1, independent of what S is about. So x hangs on y alone, by U, and all else on
///   yy: U (U - S)^-1 U,  yl: U (U - S)^-1 S_xl,  ll: S_ll + S_lx (U - S)^-1 S_xl.
class Sight {
 public:
  explicit Sight(const MetricScene& scene) : scene_(scene) {}

  void linearise(const PointElimination& elimination);

  const Matrix6d& of_eye(std::size_t keyframe) const { return of_eyes_[keyframe]; }  ///< U
  /// Of y and common unknowns, less U on y; the lower triangle.
  const Eigen::MatrixXd& information() const { return information_; }

  /// As which keyframes' steps the points take steps of y and l; `steps`: of y and common unknowns.
  Eigen::MatrixXd keyframes_for_points(const Eigen::MatrixXd& steps) const;

  /// The gradients by y and common unknowns, and the decrease of the cost that comes with them, of
  /// what eliminating the points took from the gradient by x.
  struct Pull {
    Eigen::VectorXd gradient;
    Eigen::VectorXd for_points;  ///< as `keyframes_for_points`
    double cost{0};
  };
  Pull pull(const Eigen::VectorXd& taken_from_keyframes) const;

 private:
  const MetricScene& scene_;
  std::vector<Matrix6d> of_eyes_;
  Eigen::MatrixXd of_lens_;                ///< S_xl
  Eigen::LLT<Eigen::MatrixXd> of_points_;  ///< U - S
  Eigen::MatrixXd information_;
};

}  // namespace handeye
