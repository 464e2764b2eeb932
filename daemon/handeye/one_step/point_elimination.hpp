// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/one_step/image_rows.hpp"

namespace handeye {

/// The images' normal equations with the points eliminated (Schur; Triggs et al., Bundle Adjustment
/// - A Modern Synthesis, 2000, section 6.1), in px: the noise's weight comes later, so that they
/// serve as long as poses and points stay near. They hold rows of their own for that.
class PointElimination {
 public:
  explicit PointElimination(const MetricScene& scene) : scene_(scene) {}

  /// Takes the rows: those given become the old ones.
  void eliminate(ImageRows& rows, bool lens_free);

  /// Of keyframes and common unknowns; the lower triangle.
  const Eigen::MatrixXd& information() const { return information_; }

  /// Of each keyframe alone, the points and all else fixed.
  const std::vector<Matrix6d>& information_of_eyes() const { return of_eyes_; }

  /// The gradient of keyframes and common unknowns, the points at their best.
  Eigen::VectorXd reduced(const ImageGradient& gradient) const;

  /// What the points add to the decrease of the cost that a step promises.
  double promised_by_points(const ImageGradient& gradient) const;

  /// The points' steps that go with those of the others; `step`: of keyframes and common unknowns.
  std::vector<Eigen::Vector3d> point_steps(const ImageGradient& gradient,
                                           const Eigen::VectorXd& step) const;

  /// What each point's errors, as a whole, move the common unknowns by, the point following.
  /// `by_gradient`: how unknowns answer a gradient [px^2]; unknowns x common; `for_points`: the
  /// same, as what the points follow.
  std::vector<CommonVector> pulls_of_points(const Eigen::MatrixXd& by_gradient,
                                            const Eigen::MatrixXd& for_points) const;

 private:
  using Matrix63 = Eigen::Matrix<double, 6, 3>;

  void add_point(std::size_t j);
  void write_information();
  std::size_t block(std::size_t later, std::size_t earlier) const {
    return later * (later + 1) / 2 + earlier;
  }

  const MetricScene& scene_;
  bool lens_free_{false};
  std::vector<ImageRow> rows_;
  std::vector<Eigen::Matrix3d> inverse_roots_;  ///< L^-1 of L L^T, one a point
  std::vector<Matrix6d> blocks_;                ///< keyframe by keyframe, lower triangle
  std::vector<Matrix6d> of_eyes_;               ///< the diagonal before points are eliminated
  std::vector<Matrix6d> lens_by_eye_;           ///< lens by keyframe
  LensMatrix lens_{LensMatrix::Zero()};
  std::vector<Matrix63> eliminated_;  ///< of the point at hand: W L^-T, one an observation
  Eigen::MatrixXd information_;
};

}  // namespace handeye
