// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/self_calibration.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/lens_challenge.hpp"
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
/// A lens that still moves by more in the last round has not been found.
constexpr double kUnsettledPx = 0.5;
constexpr int kMaxKeyframes = 120;
/// So many show a valley as well as all do.
constexpr int kChallengeKeyframes = 24;
/// Known worse than this a lens is not known: poses under it would be off by as much.
constexpr double kMaxFocalSigma = 0.03;
constexpr double kMaxDistortionSigmaPx = 5.0;  ///< of an image 640 px wide

/// One standard deviation of the lens along each of its principal directions.
std::vector<LensVector> principal_changes(const LensMatrix& covariance) {
  const LensVector sigma = covariance.diagonal().cwiseSqrt();
  const LensMatrix correlation =
      sigma.cwiseInverse().asDiagonal() * covariance * sigma.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<LensMatrix> eigen(correlation);
  std::vector<LensVector> changes;
  for (int i = 0; i < kLensParameters; ++i) {
    const double length = std::sqrt(std::max(0.0, eigen.eigenvalues()[i]));
    changes.emplace_back(length * sigma.cwiseProduct(eigen.eigenvectors().col(i)));
  }
  return changes;
}

/// The scene's keyframes as they are in `frames`, moved by what they do when the lens changes.
std::vector<RegisteredFrame> shifted(const std::vector<RegisteredFrame>& frames, const Scene& scene,
                                     const LensInformation& information, const LensVector& change) {
  std::vector<RegisteredFrame> result;
  for (std::size_t k = 0; k < scene.keyframes.size(); ++k) {
    const auto frame = std::ranges::lower_bound(frames, scene.keyframes[k].frame_index, {},
                                                &RegisteredFrame::index);
    if (frame == frames.end() || frame->index != scene.keyframes[k].frame_index) continue;
    const Vector6d moved = information.pose_by_lens[k] * change;
    RegisteredFrame& there = result.emplace_back(*frame);
    there.eye_from_scene.linear() = exp_so3(moved.head<3>()) * there.eye_from_scene.linear();
    there.eye_from_scene.translation() += moved.tail<3>();
  }
  return result;
}

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
  reconstruction.lens.prior = prior_;
  return reconstruction;
}

Reconstruction SelfCalibration::finish() {
  if (!started_) look_for_start();
  Reconstruction reconstruction = settle();
  reconstruction.lens.mode = mode_;
  reconstruction.lens.prior = prior_;
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
  settled_ = false;
  Reconstruction reconstruction = working_->finish();
  for (int round = 0; round < kMaxRounds && !reconstruction.frames.empty(); ++round) {
    CameraModel lens = camera_;
    Scene scene = scene_of(camera_, reconstruction, frames_, kMaxKeyframes, options_);
    if (round == 0) fit_lens(prior_, true, options_, scene, lens);
    polish_lens(prior_, options_, scene, lens);
    const double change_px = largest_difference_px(camera_, lens);
    settled_ = change_px < kUnsettledPx;
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

void SelfCalibration::judge_lens(Reconstruction& reconstruction) const {
  Lens& lens = reconstruction.lens;
  lens.observable = false;
  if (reconstruction.frames.empty()) return;
  const Scene scene = scene_of(camera_, reconstruction, frames_, kMaxKeyframes, options_);
  const auto information =
      lens_information(camera_, {whole_lens(), prior_}, options_.robust_px, scene);
  if (!information) return;
  const LensMatrix& covariance = information->covariance;
  const LensVector sigma = covariance.diagonal().cwiseSqrt();
  lens.sigma = {.focal_px = sigma[kFocal],
                .centre_px = std::max(sigma[kCentreX], sigma[kCentreY]),
                .k1 = sigma[kK1],
                .k2 = sigma[kK2],
                .distortion_px = distortion_sigma_px(camera_, covariance, scene)};
  lens.observable = settled_ && lens.sigma.focal_px <= kMaxFocalSigma * focal_px(camera_) &&
                    lens.sigma.distortion_px <= kMaxDistortionSigmaPx * camera_.width / 640.0 &&
                    refutes_other_lenses(
                        camera_, lens.sigma.focal_px, prior_, options_,
                        scene_of(camera_, reconstruction, frames_, kChallengeKeyframes, options_));
  for (const LensVector& change : principal_changes(covariance)) {
    lens.shifted_keyframes.push_back(shifted(reconstruction.frames, scene, *information, change));
  }
}

}  // namespace handeye
