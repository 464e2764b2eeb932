// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "daemon/handeye/perspective/refinement.hpp"

namespace handeye {

/// The least-squares problem behind refine(): a point P is seen at
///   distorted(K * eye_from_hand * D_i * A_i^-1 * Y^-1 * P)
/// where D_i is what position i's hand pose is wrong by.
class ProjectionProblem {
 public:
  /// Which unknowns move.
  enum class Hands {
    kExact,  ///< D_i = identity
    kFree,   ///< D_i free, X and Y fixed: as if the camera's poses had nothing to do with the hand
    kNoisy,  ///< D_i weighted by the hand's noise
  };

  /// Columns of the information matrix, in this order, then D_i; without k1 where it is fixed.
  static constexpr Eigen::Index kUnknowns = 17;  // Y (6), hand_from_eye (6), fx fy cx cy k1

  ProjectionProblem(const Observations& observations, const RefinedCalibration& start,
                    bool distortion_inside);

  /// Minimises; residuals are weighted by the noise given. False: no usable solution, or a point is
  /// not seen from where it would begin.
  bool solve(Hands hands, double image_noise_px, const HandNoise& hand_noise);

  /// Y, hand_from_eye and camera as they stand.
  RefinedCalibration calibration() const;

  /// Lengths of the points' residuals, position by position, the hands' deviations taken into
  /// account. Nothing where a point is not seen: behind the camera, off the lens, not finite.
  std::optional<std::vector<double>> errors_px() const;
  /// Of their squares; infinite where there are none.
  double sum_of_squares_px2() const;
  Eigen::Index image_residuals() const;
  Eigen::Index positions() const { return static_cast<Eigen::Index>(deviations_.size()); }
  /// k1 included or not.
  Eigen::Index unknowns() const { return distortion_inside_ ? kUnknowns : kUnknowns - 1; }
  /// Sums over positions of |w_i|^2 [rad^2] and |d_i|^2 [mm^2] of D_i.
  Eigen::Vector2d sum_of_square_deviations() const;
  void clear_deviations();

  /// Covariance of unknowns() at the last solution and its weights; D_i eliminated. Tangent of a
  /// rotation: a rotation vector [rad]. Nothing when the unknowns are not determined.
  std::optional<Eigen::MatrixXd> covariance(Hands hands, double image_noise_px,
                                            const HandNoise& hand_noise);

 private:
  struct Weighted;

  std::array<double*, 4> pose_blocks();  ///< Y's and hand_from_eye's rotation and translation

  const Observations& observations_;
  bool distortion_inside_;
  Eigen::Quaterniond object_from_hand_q_, hand_from_eye_q_;
  Eigen::Vector3d object_from_hand_t_, hand_from_eye_t_;
  Eigen::Matrix<double, 5, 1> camera_;  ///< fx, fy, cx, cy, k1
  std::vector<Vector6d> deviations_;    ///< D_i: rotation vector [rad], translation [mm]
};

}  // namespace handeye
