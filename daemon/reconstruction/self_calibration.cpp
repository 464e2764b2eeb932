// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/self_calibration.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/lens_fit.hpp"
#include "daemon/reconstruction/lens_information.hpp"
#include "daemon/reconstruction/lens_scene.hpp"
#include "daemon/reconstruction/lens_start.hpp"

namespace handeye {
namespace {

/// Horizontal field of view of a first guess: an endoscope's.
constexpr double kGuessedFieldRad = rad_from_deg(62.0);
/// Image movement, in widths, before a first lens is looked for: enough for parallax.
constexpr double kMovementToStart = 0.5;
constexpr int kMaxRounds = 5;
/// Above this change anywhere in the image a new reconstruction is worth its time.
constexpr double kBeginAgainPx = 4.0;
constexpr double kSettledPx = 0.05;
constexpr int kMaxKeyframes = 120;

}  // namespace

SelfCalibration::SelfCalibration(const CameraModel& camera, IntrinsicsMode mode,
                                 const ReconstructionOptions& options)
    : mode_(mode),
      options_(options),
      camera_(mode == IntrinsicsMode::kEstimate
                  ? plain_camera(camera.width, camera.height, kGuessedFieldRad)
                  : camera),
      prior_(lens_prior(camera_, mode)),
      working_(std::make_unique<IncrementalReconstruction>(camera_, options)),
      started_(mode != IntrinsicsMode::kEstimate),
      look_at_px_(kMovementToStart * camera.width) {}

ReconstructionState SelfCalibration::add(const TrackedFrame& frame) {
  if (!frames_.empty()) {
    moved_px_ += median_movement_px(
        camera_, common_features(make_record(frames_.back()), make_record(frame)));
  }
  frames_.push_back(frame);
  const ReconstructionState state = working_->add(frame);
  if (!started_ && moved_px_ >= look_at_px_) {
    look_for_start();
    look_at_px_ = 2.0 * moved_px_;
  }
  return state;
}

Reconstruction SelfCalibration::current() const {
  Reconstruction reconstruction = working_->current();
  reconstruction.lens.mode = mode_;
  return reconstruction;
}

Reconstruction SelfCalibration::finish() {
  if (!started_) look_for_start();
  Reconstruction reconstruction = settle();
  reconstruction.lens.mode = mode_;
  judge_lens(reconstruction);
  return reconstruction;
}

void SelfCalibration::look_for_start() {
  const auto found = find_start_lens(camera_.width, camera_.height, frames_, options_);
  if (!found) return;
  started_ = true;
  begin_again(*found);
}

void SelfCalibration::begin_again(const CameraModel& camera) {
  camera_ = camera;
  working_ = std::make_unique<IncrementalReconstruction>(camera_, options_);
  for (const TrackedFrame& frame : frames_) working_->add(frame);
}

/// Reconstruction and adjustment of the lens in turn, until the lens stays.
Reconstruction SelfCalibration::settle() {
  Reconstruction reconstruction = working_->finish();
  for (int round = 0; round < kMaxRounds && !reconstruction.frames.empty(); ++round) {
    CameraModel lens = camera_;
    Scene scene = scene_of(camera_, reconstruction, frames_, kMaxKeyframes, options_);
    if (round == 0) fit_lens(prior_, true, options_, scene, lens);
    polish_lens(prior_, options_, scene, lens);
    const double change_px = largest_difference_px(camera_, lens);
    if (change_px < kSettledPx) break;
    if (change_px > kBeginAgainPx) {
      begin_again(lens);
    } else {
      camera_ = lens;
      working_->set_camera(lens);
    }
    reconstruction = working_->finish();
  }
  return reconstruction;
}

void SelfCalibration::judge_lens(Reconstruction& reconstruction) {
  Lens& lens = reconstruction.lens;
  lens.observable = false;
  if (reconstruction.frames.empty()) return;
  Scene scene = scene_of(camera_, reconstruction, frames_, kMaxKeyframes, options_);
  const auto information =
      lens_information(camera_, {whole_lens(), prior_}, options_.robust_px, scene);
  if (!information) return;
  const LensMatrix& covariance = information->covariance;
  const LensVector sigma = covariance.diagonal().cwiseSqrt();
  lens.sigma = {.focal_px = sigma[kFocal],
                .centre_px = std::max(sigma[kCentreX], sigma[kCentreY]),
                .k1 = sigma[kK1],
                .k2 = sigma[kK2],
                .distortion_px = distortion_sigma_px(camera_, covariance)};
  lens.observable = true;
}

}  // namespace handeye
