// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/handeye/maximum_likelihood.hpp"

namespace handeye {

/// The hand at a frame, from the tracker's samples around it.
struct HandAtFrame {
  Pose room_from_hand{Pose::Identity()};                      ///< mm
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};  ///< in the hand frame [rad/s]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};          ///< of its origin, in the room [mm/s]
  /// Which samples: this one of the tracker's stream and those that follow it, and by what shares
  /// their errors are this one's; between two samples 1-a and a. Frames that share a sample share
  /// its error.
  std::int64_t sample{0};
  std::vector<double> shares{1.0};
  /// Of one sample here, as the tracker itself says (6dcov): of (w [rad], dt [mm]) in the room,
  /// R = Exp(w) R_measured, t = t_measured + dt.
  std::optional<Matrix6d> sample_covariance;
};

/// A frame that was registered in the reconstruction.
struct OneStepFrame {
  Pose eye_from_scene{Pose::Identity()};  ///< start; scene units of its part
  int part{0};                            ///< parts have a scene and a scale of their own
  bool keyframe{false};                   ///< its observations are among the points'
  /// Of a frame that is none: of (w [rad], dt [scene units]) of eye_from_scene, R = Exp(w) R,
  /// t = t + dt, at an image noise of 1 px, the points as they are.
  Matrix6d unit_covariance{Matrix6d::Zero()};
  std::optional<HandAtFrame> hand;  ///< nothing: the tracker did not see it
};

struct OneStepPoint {
  struct Observation {
    int frame{0};  ///< position in OneStepProblem::frames; a keyframe of the same part
    Eigen::Vector2d pixel;
  };
  int part{0};
  Eigen::Vector3d point_scene{Eigen::Vector3d::Zero()};  ///< start; scene units
  std::vector<Observation> observations;                 ///< ordered by frame
};

struct OneStepProblem {
  CameraModel camera;                ///< the lens, or where it starts
  std::vector<OneStepFrame> frames;  ///< in order of time
  std::vector<OneStepPoint> points;
};

/// Where the noise of a tracker's sample comes from.
enum class HandNoiseSource {
  kGiven,      ///< the options
  kMeasured,   ///< each sample's own covariance; the options where one has none
  kEstimated,  ///< the residuals; the options are the start
};

struct OneStepOptions {
  std::optional<LensPrior> lens;           ///< free, with this prior; nothing: given
  double hand_rotation_sigma_rad{0.001};   ///< of one sample, per axis
  double hand_translation_sigma_mm{0.15};  ///< of one sample, per axis
  HandNoiseSource hand_noise{HandNoiseSource::kEstimated};
  std::optional<double> image_noise_px;  ///< per axis; nothing: from the residuals
  bool estimate_time_offset{true};       ///< false: held where it is, for want of motion
  double time_offset_prior_s{0.05};      ///< standard deviation of the correction before the data
  double huber{2.5};       ///< Huber's loss, in standard deviations: touches inliers hardly
  double reject{6.0};      ///< tracker poses beyond this norm (6 dof) are left out in the end
  int max_iterations{30};  ///< of one minimisation
  int noise_rounds{12};    ///< at most, of minimising and estimating the noise
};

struct OneStepResult {
  Pose hand_from_eye{Pose::Identity()};  ///< mm
  /// Of (w [rad], dt [mm]) in R = Exp(w) R_estimate, t = t_estimate + dt of hand_from_eye, all else
  /// free: structure, poses, time and, where it is free, the lens.
  Matrix6d covariance{Matrix6d::Zero()};
  /// Of the log of the camera's path, as long as it is in the room: of the part that knows it best.
  double log_scale_sigma{0};
  /// To be added to the time offset that the hand was looked up with; first order.
  double time_offset_correction_s{0};
  double time_offset_sigma_s{0};
  CameraModel camera;  ///< as given, or as found
  LensMatrix lens_covariance{LensMatrix::Zero()};
  double hand_rotation_sigma_rad{0};    ///< as given (mean, where measured) or estimated
  double hand_translation_sigma_mm{0};  ///< likewise
  double image_noise_px{0};             ///< likewise; weighed as 0.1 at least
  double reprojection_px{0};            ///< rms over the keyframes' observations
  double chi2_per_dof{0};               ///< of the tracker's residuals against the noise assumed
  double correlation_inflation{1};      ///< of the covariance, for errors correlated in time
  std::vector<std::optional<Pose>> eye_from_room;  ///< of each frame, mm; nothing: left out
  std::vector<std::size_t> rejected;  ///< frames whose tracker pose was an outlier, ascending
  int iterations{0};
};

/// One step without a pattern (docs/math.md section 8): a bundle adjustment in room coordinates and
/// mm that has the hand's poses in it. Minimised over hand_from_eye, the time offset, the
/// keyframes' poses, the points and, if wanted, the lens:
///   reprojection of every point in every keyframe, and
///   for every frame the hand that the camera implies, room_from_eye * eye_from_hand, against the
///   tracker's at its time.
/// The scale needs no unknown: the tracker gives it. Frames that are no keyframes were resected
/// against the structure and follow it (sight.hpp); what their images say of the structure itself
/// is not known here: the more keyframes, the better. `start`: of the same frames, for where X and
/// every part's scene lie. Deterministic, one thread. Nothing where numbers are not finite, fewer
/// than three frames have a hand, or the normal equations determine nothing.
std::optional<OneStepResult> one_step(const OneStepProblem& problem,
                                      const MaximumLikelihoodResult& start,
                                      const OneStepOptions& options = {});

}  // namespace handeye
