// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/noise_model.hpp"
#include "daemon/handeye/parted_poses.hpp"

namespace handeye {

/// Of each part: a reconstruction that started anew errs in its own way.
using PartNoise = std::vector<ResidualNoise::Variances>;

/// The weighted least-squares problem of `maximum_likelihood`: a sum over poses with Huber's loss,
/// and its minimiser. Parts in the order of parts_of(); one of whose poses none counts is not in
/// use, and its own unknowns are not estimated.
class PoseProblem {
 public:
  /// Poses of parts that are too small do not count.
  PoseProblem(std::span<const HandEyeObservation> observations, const HandEyeSolution& start,
              const MaximumLikelihoodOptions& options);

  /// The normal equations at given unknowns. Unknowns that are not estimated have a unit diagonal
  /// and no gradient.
  struct NormalEquations {
    double cost{0};
    PartedVector gradient;
    PartedMatrix information;  ///< Gauss-Newton's
  };
  NormalEquations normal_equations(const PartNoise& noise, const PartedUnknowns& unknowns) const {
    return equations_at(noise, unknowns, true);
  }
  PartedVector gradient(const PartNoise& noise, const PartedUnknowns& unknowns) const {
    return equations_at(noise, unknowns, false).gradient;
  }

  /// Levenberg-Marquardt from where it stands, poses that were left out not counted. The prior of
  /// a scale is taken about where it starts.
  void minimise(const PartNoise& noise);

  /// From now on the part's scale is not estimated but this, while the eye's noise holds where it
  /// held; estimated again, about where it stands.
  void hold_scale(std::size_t part, double log_scale);
  void free_scale() { held_scale_.reset(); }

  /// From now on the noise of the eye as given holds at these scales, one a part; by default it
  /// holds where the scale is when `minimise` is called.
  void noise_holds_at(std::span<const double> scales_units_per_mm);
  std::span<const double> start_scales() const { return poses_.scales_units_per_mm; }

  /// Counts only the poses that are true in `kept`, from now on.
  void keep(std::vector<bool> kept);
  const std::vector<bool>& kept() const { return kept_; }

  std::span<const Part> parts() const { return poses_.parts; }
  bool in_use(std::size_t part) const { return poses_kept_[part] > 0; }
  std::size_t poses_kept(std::size_t part) const { return poses_kept_[part]; }

  /// Not whitened; of the poses of a part that count.
  std::vector<Vector6d> residuals(std::size_t part) const;
  /// Of the whitened residuals; of all poses, infinite in parts that are not in use.
  std::vector<double> norms(const PartNoise& noise) const;
  /// What the poses of a part that count add to the cost.
  double cost_of(std::size_t part, const PartNoise& noise) const;

  bool estimates(int unknown, std::size_t part) const;
  /// Number of unknowns that are estimated: a part's own, and its share by poses in the common
  /// ones.
  double parameters_of(std::size_t part) const;
  const PartedUnknowns& unknowns() const { return unknowns_; }
  HandEyeSolution solution(std::size_t part) const;  ///< with that part's scale
  Pose room_from_scene(std::size_t part) const {     ///< scene in mm
    return poses_.room_from_scene(part, unknowns_.of(part));
  }

 private:
  /// `with_information`: else only cost and gradient.
  NormalEquations equations_at(const PartNoise& noise, const PartedUnknowns& unknowns,
                               bool with_information) const;
  void add_poses(std::size_t part, const PartNoise& noise, const PartedUnknowns& unknowns,
                 NormalEquations& equations, bool with_information) const;
  void add_priors(const PartedUnknowns& unknowns, NormalEquations& equations,
                  bool with_information) const;
  void add_cost(std::size_t part, const PartNoise& noise, const PartedUnknowns& unknowns,
                double& cost) const;
  double cost(const PartNoise& noise, const PartedUnknowns& unknowns) const;
  double prior_cost(const PartedUnknowns& unknowns) const;
  double loss(double norm) const;

  MaximumLikelihoodOptions options_;
  PartedPoses poses_;
  std::vector<bool> kept_;
  std::vector<std::size_t> poses_kept_;  ///< one a part
  PartedUnknowns unknowns_;
  std::vector<double> prior_log_scales_;
  std::vector<double> noise_log_scales_;  ///< where the eye's noise holds
  bool noise_follows_{true};
  std::optional<std::size_t> held_scale_;
};

/// Their positions.
inline std::vector<std::size_t> parts_in_use(const PoseProblem& problem) {
  std::vector<std::size_t> result;
  for (std::size_t p = 0; p < problem.parts().size(); ++p) {
    if (problem.in_use(p)) result.push_back(p);
  }
  return result;
}

}  // namespace handeye
