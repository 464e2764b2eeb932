// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/noise_model.hpp"
#include "daemon/handeye/pose_residual.hpp"

namespace handeye {

/// The weighted least-squares problem of `maximum_likelihood`: a sum over poses with Huber's loss,
/// and its minimiser. Scene in mm by the start's scale, room and scene counted from the mean of
/// their poses, which keeps the normal equations well conditioned whatever the origins.
class PoseProblem {
 public:
  PoseProblem(std::span<const HandEyeObservation> observations, const HandEyeSolution& start,
              const MaximumLikelihoodOptions& options);

  /// The normal equations at given unknowns. Unknowns that are not estimated have a unit diagonal
  /// and no gradient.
  struct NormalEquations {
    double cost{0};
    UnknownsVector gradient{UnknownsVector::Zero()};
    UnknownsMatrix information{UnknownsMatrix::Zero()};  ///< Gauss-Newton's
  };
  NormalEquations normal_equations(const ResidualNoise::Variances& noise,
                                   const PoseUnknowns& unknowns) const;

  UnknownsVector gradient(const ResidualNoise::Variances& noise,
                          const PoseUnknowns& unknowns) const;

  /// Levenberg-Marquardt from where it stands, poses that were left out not counted. The prior of
  /// the scale is taken about where it starts.
  void minimise(const ResidualNoise::Variances& noise);

  /// From now on the scale is not estimated but this, while the eye's noise holds where it held;
  /// estimated again, about where it stands.
  void hold_scale(double log_scale);
  void free_scale() { options_.estimate_scale = true; }

  /// From now on the noise of the eye as given holds at this scale; by default it holds where the
  /// scale is when `minimise` is called.
  void noise_holds_at(double scale_units_per_mm);

  /// Counts only the poses that are true in `kept`, from now on.
  void keep(std::vector<bool> kept) { kept_ = std::move(kept); }
  const std::vector<bool>& kept() const { return kept_; }

  /// Not whitened; of the poses that count.
  std::vector<Vector6d> residuals() const;
  /// Of the whitened residuals; of all poses.
  std::vector<double> norms(const ResidualNoise::Variances& noise) const;

  bool estimates(int unknown) const;
  int parameters() const;  ///< number of unknowns that are estimated
  const PoseUnknowns& unknowns() const { return unknowns_; }
  HandEyeSolution solution() const;
  Pose room_from_scene() const;  ///< scene in mm

 private:
  /// Adds up the poses, the information where there is room for it.
  void add_poses(const ResidualNoise::Variances& noise, const PoseUnknowns& unknowns, double& cost,
                 UnknownsVector& gradient, UnknownsMatrix* information) const;
  void add_priors(const PoseUnknowns& unknowns, UnknownsVector& gradient,
                  UnknownsMatrix* information) const;
  double cost(const ResidualNoise::Variances& noise, const PoseUnknowns& unknowns) const;
  double prior_cost(const PoseUnknowns& unknowns) const;
  double loss(double norm) const;

  MaximumLikelihoodOptions options_;
  std::vector<CentredPose> poses_;
  std::vector<bool> kept_;
  double start_scale_{1};
  Eigen::Vector3d room_centre_mm_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d scene_centre_mm_{Eigen::Vector3d::Zero()};
  PoseUnknowns unknowns_;
  double prior_log_scale_{0};
  double noise_log_scale_{0};  ///< where the eye's noise holds
  bool noise_follows_{true};
};

}  // namespace handeye
