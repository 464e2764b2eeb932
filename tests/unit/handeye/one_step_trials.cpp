// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_trials.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

namespace handeye::synthetic {

void OneStepFigures::add(const Vector6d& error, const Matrix6d& covariance, double offset_error_s,
                         double offset_sigma_s) {
  ++trials_;
  rotation_square_ += error.head<3>().squaredNorm();
  translation_square_ += error.tail<3>().squaredNorm();
  claimed_rotation_square_ += covariance.topLeftCorner<3, 3>().trace();
  claimed_translation_square_ += covariance.bottomRightCorner<3, 3>().trace();
  nees_ += error.dot(covariance.ldlt().solve(error));
  offset_ += offset_error_s;
  offset_square_ += offset_error_s * offset_error_s;
  claimed_offset_square_ += offset_sigma_s * offset_sigma_s;
  worst_ = std::max({worst_, deg_from_rad(error.head<3>().norm()) / sigma_rotation_deg(covariance),
                     error.tail<3>().norm() / sigma_translation_mm(covariance)});
}

void OneStepFigures::add(const OneStepBound& bound) {
  ++bounds_;
  bound_rotation_square_ += bound.hand_from_eye.topLeftCorner<3, 3>().trace();
  bound_translation_square_ += bound.hand_from_eye.bottomRightCorner<3, 3>().trace();
}

double OneStepFigures::rms_rotation_deg() const {
  return deg_from_rad(std::sqrt(rotation_square_ / trials_));
}

double OneStepFigures::rms_translation_mm() const {
  return std::sqrt(translation_square_ / trials_);
}

double OneStepFigures::bound_rotation_deg() const {
  return deg_from_rad(std::sqrt(bound_rotation_square_ / bounds_));
}

double OneStepFigures::bound_translation_mm() const {
  return std::sqrt(bound_translation_square_ / bounds_);
}

double OneStepFigures::claimed_rotation_deg() const {
  return deg_from_rad(std::sqrt(claimed_rotation_square_ / trials_));
}

double OneStepFigures::claimed_translation_mm() const {
  return std::sqrt(claimed_translation_square_ / trials_);
}

double OneStepFigures::mean_nees() const {
  return nees_ / trials_;
}

double OneStepFigures::mean_offset_s() const {
  return offset_ / trials_;
}

double OneStepFigures::rms_offset_s() const {
  return std::sqrt(offset_square_ / trials_);
}

double OneStepFigures::claimed_offset_s() const {
  return std::sqrt(claimed_offset_square_ / trials_);
}

double OneStepFigures::offset_bias() const {
  return std::abs(mean_offset_s()) / (rms_offset_s() / std::sqrt(trials_));
}

std::string header() {
  return fmt::format(
      "{:<34} {:>7} {:>6} {:>6} {:>7} {:>6} {:>6} {:>6} {:>7} {:>7} {:>6} {:>5} {:>5}\n", "",
      "rot deg", "/bound", "/claim", "trans mm", "/bound", "/claim", "NEES", "dt ms", "rms ms",
      "/claim", "worst", "fails");
}

std::string row(const OneStepFigures& f) {
  return fmt::format(
      "{:7.4f} {:6.3f} {:6.3f} {:8.4f} {:6.3f} {:6.3f} {:6.2f} {:7.3f} {:7.3f} {:6.3f} {:5.1f} "
      "{:5}",
      f.rms_rotation_deg(), f.rotation_to_bound(), f.rms_rotation_deg() / f.claimed_rotation_deg(),
      f.rms_translation_mm(), f.translation_to_bound(),
      f.rms_translation_mm() / f.claimed_translation_mm(), f.mean_nees(), 1e3 * f.mean_offset_s(),
      1e3 * f.rms_offset_s(), f.rms_offset_s() / f.claimed_offset_s(), f.worst(), f.failures());
}

NeesBand nees_band(int trials) {
  const boost::math::chi_squared distribution(6.0 * trials);
  return {boost::math::quantile(distribution, 0.0005) / trials,
          boost::math::quantile(distribution, 0.9995) / trials};
}

OneStepStudy study(const OneStepSceneOptions& options, HandNoiseSource source, int seeds,
                   int bound_every) {
  OneStepStudy result;
  for (int seed = 0; seed < seeds; ++seed) {
    const OneStepScene scene = one_step_scene(options, static_cast<std::uint32_t>(seed));
    if (bound_every > 0 && seed % bound_every == 0) {
      const OneStepBound bound = one_step_bound(scene);
      result.one_step.add(bound);
      result.likelihood.add(bound);
    }
    const auto start = start_of(scene);
    if (!start) {
      result.one_step.add_failure();
      result.likelihood.add_failure();
      continue;
    }
    const auto add = [&](const auto& found, const Pose& hand_from_eye, OneStepFigures& figures) {
      figures.add(error_of(hand_from_eye, scene.hand_from_eye), found.covariance,
                  scene.time_offset_error_s - found.time_offset_correction_s,
                  found.time_offset_sigma_s);
    };
    add(*start, start->solution.hand_from_eye, result.likelihood);
    const auto found = one_step(scene.problem, *start, one_step_options(scene, source));
    if (found) {
      add(*found, found->hand_from_eye, result.one_step);
    } else {
      result.one_step.add_failure();
    }
  }
  return result;
}

}  // namespace handeye::synthetic
