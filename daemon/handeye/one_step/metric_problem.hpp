// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/handeye/one_step/hand_equations.hpp"
#include "daemon/handeye/one_step/huber_norm.hpp"
#include "daemon/handeye/one_step/normal_equations.hpp"

namespace handeye {

/// Where the equations promise less decrease of the cost, it is the minimum: 0.014 sigma of a step.
inline constexpr double kSettledPromise = 1e-4;

/// How minimising ended.
enum class Minimisation {
  kNothing,    ///< the equations determine nothing, or a number is none
  kUnsettled,  ///< out of iterations, or where no step is small enough to lead down
  kSettled,    ///< where the equations, linearised near it, promise no step worth taking
};

/// The least-squares problem of `one_step` at a given noise, and its minimiser: Gauss-Newton with
/// the points eliminated, damped where a step fails (Levenberg, Marquardt). Near the minimum the
/// images' equations are linearised once and only the gradient is computed anew: that alone says
/// where the minimum is.
class MetricProblem {
 public:
  MetricProblem(const MetricScene& scene, const OneStepOptions& options);

  /// Which frames' hands count: one a frame of the scene.
  void keep(std::vector<bool> kept) { hands_.kept = std::move(kept); }
  /// From where it stands.
  Minimisation minimise(MetricNoise noise);
  /// Linearises everything where it stands, for `equations`: by how much they promise that the cost
  /// falls still. Nothing where they determine nothing.
  std::optional<double> linearise_anew();

  const MetricScene& scene() const { return scene_; }
  const OneStepOptions& options() const { return options_; }
  const MetricState& state() const { return state_; }
  const MetricNoise& noise() const { return noise_; }
  const std::vector<bool>& kept() const { return hands_.kept; }
  const HandSelection& hands() const { return hands_; }
  const std::vector<Pose>& eyes() const { return here_.eyes; }
  const std::vector<HandRow>& hand_rows() const { return hand_rows_; }
  const NormalEquations& equations() const { return equations_; }
  double cost() const { return here_.cost; }
  double image_squares() const { return here_.rows.squares; }  ///< [px^2]
  const ImageRows& image_rows() const { return here_.rows; }
  /// Likewise weighted by the loss, and made good for what the loss takes from inliers.
  double robust_image_squares() const;
  /// What the loss leaves of the squares of tracker residuals that are inliers.
  double share_of_hand_squares() const { return huber_of_hand_.share_of_squares; }
  bool lens_free() const { return options_.lens.has_value(); }
  /// Of the common unknowns; else it keeps its value.
  bool estimates(Eigen::Index common) const { return equations_.estimates(common); }
  int iterations() const { return iterations_; }

 private:
  /// A place that is tried, or taken.
  struct Place {
    ImageRows rows;
    std::vector<Pose> eyes;
    std::vector<Pose> sighted;  ///< keyframes by sight, where frames follow
    double cost{0};
  };

  /// Where the cost was least before it went up for some steps.
  struct Stand {
    MetricState state;
    double cost{0};
  };

  bool evaluate(const MetricState& state, Place& place) const;
  double prior_cost(const MetricState& state) const;
  MetricColumns gradient() const;  ///< of hands and priors
  bool factorise(double damping);
  void eliminate_points();
  /// From a step that was none to where the cost was least, to damp it there; false as `evaluate`.
  bool retreat(double& damping);
  void set_noise(MetricNoise noise);

  const MetricScene& scene_;
  OneStepOptions options_;
  MetricState state_;
  MetricNoise noise_;
  HandSelection hands_;
  HuberNorm huber_of_image_, huber_of_hand_;
  NormalEquations equations_;
  std::vector<Pose> sighted_at_start_;
  bool eliminated_{false};      ///< at a place that was taken
  bool at_elimination_{false};  ///< and has not been left
  Place here_, next_;
  std::optional<Stand> least_;
  std::vector<HandRow> hand_rows_;
  std::optional<MetricNoise> factor_noise_;  ///< nothing: none, or damped
  int iterations_{0};
};

}  // namespace handeye
