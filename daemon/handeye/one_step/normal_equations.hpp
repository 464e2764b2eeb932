// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Cholesky>

#include "daemon/handeye/one_step/hand_equations.hpp"
#include "daemon/handeye/one_step/sight.hpp"

namespace handeye {

/// The normal equations of `one_step`, points eliminated. Where all frames are keyframes they are
/// those of keyframes and common unknowns. Where frames follow, they are those of keyframes by
/// sight and common unknowns: the keyframes, each on its own, are eliminated too.
class NormalEquations {
 public:
  NormalEquations(const MetricScene& scene, const OneStepOptions& options)
      : scene_(scene), options_(options), elimination_(scene), sight_(scene) {}

  /// Takes the rows: those given become the old ones.
  void linearise(ImageRows& rows);
  /// At an image noise; false where nothing is determined.
  bool factorise(std::span<const HandRow> hands, double image_px, double damping);

  bool estimates(Eigen::Index common) const;

  /// Of all unknowns at the minimum of the equations, the gradients being these.
  struct Step {
    Eigen::VectorXd of_unknowns;
    std::vector<Eigen::Vector3d> of_points;
    double promised{0};  ///< decrease of the cost
  };
  /// `others`: gradients of hands and priors.
  Step step(const ImageGradient& of_images, MetricColumns others) const;

  /// H^-1 right: H is the information of keyframes, keyframes by sight and common unknowns.
  MetricColumns solve(const MetricColumns& right) const;

  /// What each point's errors, as a whole, move the common unknowns by; `by_common`: H^-1 of these.
  std::vector<CommonVector> pulls_of_points(const MetricColumns& by_common) const;

  /// Zero gradients of so many columns.
  MetricColumns zero(Eigen::Index columns) const;

 private:
  using CommonByEye = Eigen::Matrix<double, kLensInCommon, 6>;
  /// A keyframe that hangs on itself by sight.
  struct Hanging {
    Matrix6d inverse{Matrix6d::Zero()};            ///< of its information
    Matrix6d sight{Matrix6d::Zero()};              ///< U at the image noise
    CommonByEye with_common{CommonByEye::Zero()};  ///< of its tracker sample
  };

  double weight() const { return 1.0 / (image_px_ * image_px_); }
  bool follows() const { return scene_.has_followers(); }
  void add_hands(std::span<const HandRow> hands, Eigen::MatrixXd& information);
  void hang_keyframes(double damping, Eigen::MatrixXd& information);
  void add_priors(Eigen::MatrixXd& information) const;
  /// Of keyframes by sight, or keyframes where none follow, and common unknowns.
  Eigen::MatrixXd joined(const MetricColumns& columns) const;

  const MetricScene& scene_;
  const OneStepOptions& options_;
  PointElimination elimination_;
  Sight sight_;
  double image_px_{1};
  std::vector<Hanging> hanging_;
  std::vector<Matrix6d> of_hands_;  ///< of the keyframes' tracker samples
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace handeye
