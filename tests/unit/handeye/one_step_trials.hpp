// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/unit/handeye/one_step_information.hpp"
#include "tests/unit/handeye/one_step_scenes.hpp"

namespace handeye::synthetic {

/// Figures of an estimator over seeds.
class OneStepFigures {
 public:
  /// `error`: as error_of.
  void add(const Vector6d& error, const Matrix6d& covariance, double offset_error_s,
           double offset_sigma_s);
  void add(const OneStepBound& bound);
  void add_failure() { ++failures_; }

  int trials() const { return trials_; }
  int failures() const { return failures_; }
  double rms_rotation_deg() const;
  double rms_translation_mm() const;
  double bound_rotation_deg() const;  ///< rms
  double bound_translation_mm() const;
  double rotation_to_bound() const { return rms_rotation_deg() / bound_rotation_deg(); }
  double translation_to_bound() const { return rms_translation_mm() / bound_translation_mm(); }
  double claimed_rotation_deg() const;  ///< rms
  double claimed_translation_mm() const;
  double mean_nees() const;  ///< of 6 degrees of freedom
  double mean_offset_s() const;
  double rms_offset_s() const;
  double claimed_offset_s() const;  ///< rms
  /// Mean offset error in its standard deviations of chance.
  double offset_bias() const;
  /// Largest error in its own standard deviations, of rotation or translation.
  double worst() const { return worst_; }

 private:
  int trials_{0};
  int bounds_{0};
  int failures_{0};
  double rotation_square_{0}, translation_square_{0};
  double bound_rotation_square_{0}, bound_translation_square_{0};
  double claimed_rotation_square_{0}, claimed_translation_square_{0};
  double nees_{0};
  double offset_{0}, offset_square_{0}, claimed_offset_square_{0};
  double worst_{0};
};

/// Of one estimator and the same scenes' bound.
std::string row(const OneStepFigures& figures);
std::string header();

/// Bounds of the mean of `trials` NEES of 6 degrees of freedom that hold 99.9 %.
struct NeesBand {
  double low, high;
};
NeesBand nees_band(int trials);

struct OneStepStudy {
  OneStepFigures one_step;
  OneStepFigures likelihood;  ///< of the start
};

/// Seeds 0 to `seeds` - 1; the bound of every `bound_every`th, none for 0.
OneStepStudy study(const OneStepSceneOptions& options, HandNoiseSource source, int seeds,
                   int bound_every = 1);

}  // namespace handeye::synthetic
