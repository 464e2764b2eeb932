// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_scenes.hpp"

#include <cmath>

#include <Eigen/Dense>

#include "daemon/sync/hand_smoothing.hpp"
#include "tests/unit/handeye/one_step_structure.hpp"

namespace handeye::synthetic {
namespace {

constexpr double kUncertainStretch = 3.0;  // of the noise that varies, along the room's z
constexpr double kOutlier_deg = 3;
constexpr double kOutlier_mm = 10;

class Noise {
 public:
  explicit Noise(std::mt19937& generator) : generator_(generator) {}
  double normal() { return normal_(generator_); }
  Eigen::Vector3d normal3() {
    const double x = normal();
    const double y = normal();
    return {x, y, normal()};
  }
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(generator_);
  }

 private:
  std::mt19937& generator_;
  std::normal_distribution<double> normal_;
};

std::int64_t nanoseconds(double time_s) {
  return std::llround(time_s * 1e9);
}

/// Of (w, dt) of a sample, in the room. Where the noise varies, the tracker sees badly in turns of
/// some seconds, and along its line of sight worse than across.
Matrix6d covariance_of_sample(const OneStepSceneOptions& options, double time_s) {
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(options.hand_rotation_sigma_rad),
      Eigen::Vector3d::Constant(options.hand_translation_sigma_mm);
  if (options.hand_noise_varies) {
    sigma *= std::pow(4.0, std::sin(2 * kPi * 0.4 * time_s)) / 2.0;
    sigma[5] *= kUncertainStretch;
  }
  return sigma.cwiseAbs2().asDiagonal();
}

/// `time_s`: by the tracker's clock; what it sees then happened when `true_s` says.
HandSample sample(const OneStepSceneOptions& options, const Pose& room_from_hand,
                  const Matrix6d& covariance, double time_s, Noise& noise) {
  Vector6d error;
  error << noise.normal3(), noise.normal3();
  error = covariance.diagonal().cwiseSqrt().cwiseProduct(error);
  if (noise.uniform(0, 1) < options.outlier_samples) {
    error.head<3>() += rad_from_deg(kOutlier_deg) * noise.normal3();
    error.tail<3>() += kOutlier_mm * noise.normal3();
  }
  HandSample result{.timestamp_ns = nanoseconds(time_s), .tracked = true};
  result.room_from_hand.linear() = exp_so3(-error.head<3>()) * room_from_hand.linear();
  result.room_from_hand.translation() = room_from_hand.translation() - error.tail<3>();
  if (options.hand_noise_varies) result.covariance = covariance.cast<float>();
  return result;
}

HandAtFrame hand_of(const SmoothedHand& found) {
  return {.room_from_hand = found.room_from_hand,
          .angular_velocity = found.angular_velocity,
          .velocity = found.velocity,
          .sample = found.sample,
          .shares = found.shares,
          .sample_covariance = found.sample_covariance};
}

/// Fills the scene's samples, and the hand of every frame by looking it up as the daemon does, at a
/// time offset of zero.
void add_hands(Noise& noise, OneStepScene& scene) {
  const OneStepSceneOptions& options = scene.options;
  const Pose eye_from_hand = scene.hand_from_eye.inverse();
  const double ends_s =
      static_cast<double>(scene.problem.frames.size()) / options.tracks.rate_hz + 0.2;
  PoseBuffer buffer;
  for (double time_s = -0.2 - noise.uniform(0, 1) / options.tracker_hz; time_s < ends_s;
       time_s += 1 / options.tracker_hz) {
    // Camera stamp = tracker stamp + offset, of the same instant.
    const double true_s = options.tracks.from_s + time_s + scene.time_offset_error_s;
    scene.sample_covariance.push_back(covariance_of_sample(options, time_s));
    buffer.push(sample(options, options.tracks.motion(true_s) * eye_from_hand,
                       scene.sample_covariance.back(), time_s, noise));
  }
  std::optional<HandSmoothing> smoothing;
  if (options.smooth_hands) smoothing.emplace(buffer);
  for (std::size_t k = 0; k < scene.problem.frames.size(); ++k) {
    const std::int64_t time_ns = nanoseconds(static_cast<double>(k) / options.tracks.rate_hz);
    if (smoothing) {
      if (auto found = smoothing->at(time_ns)) scene.problem.frames[k].hand = hand_of(*found);
      continue;
    }
    const HandLookup found = buffer.lookup(time_ns);
    if (found.status != LookupStatus::kOk) continue;
    scene.problem.frames[k].hand = HandAtFrame{.room_from_hand = found.room_from_hand,
                                               .angular_velocity = found.angular_velocity,
                                               .velocity = found.velocity,
                                               .sample = found.sample,
                                               .shares = {1 - found.fraction, found.fraction},
                                               .sample_covariance = found.sample_covariance};
  }
}

}  // namespace

OneStepScene one_step_scene(const OneStepSceneOptions& asked, std::uint32_t seed) {
  std::mt19937 generator(seed);
  Noise noise(generator);
  OneStepScene scene{.options = asked};
  OneStepSceneOptions& options = scene.options;
  options.tracks.from_s += noise.uniform(0, 60);
  scene.tracks = tracks(options.tracks, generator);
  scene.hand_from_eye = scope().solution.hand_from_eye;
  scene.time_offset_error_s = asked.time_offset_error_s * noise.uniform(-1, 1);
  if (options.lens) {
    scene.lens_prior = lens_prior(scene.tracks.camera, *options.lens);
    scene.lens_prior->mean = lens_vector(scene.tracks.camera);
    for (int i = 0; i < kLensParameters; ++i) {
      scene.lens_prior->mean[i] += scene.lens_prior->sigma[i] * noise.normal();
    }
  }
  std::vector<SceneOfPart> scenes;
  for (int part = 0; part < options.tracks.parts; ++part) {
    const Truth truth = random_truth(generator, 0.02 * (1 + part));
    scenes.push_back({truth.room_from_scene, truth.solution.scale_units_per_mm});
  }
  scene.problem = reconstruct(scene.tracks, scenes, options.keyframe_interval, scene.lens_prior,
                              options.tracks.noise_px);
  add_hands(noise, scene);
  return scene;
}

std::vector<HandEyeObservation> observations_of(const OneStepProblem& problem) {
  std::vector<HandEyeObservation> observations;
  for (const OneStepFrame& frame : problem.frames) {
    if (!frame.hand) continue;
    observations.push_back({.poses = {frame.hand->room_from_hand, frame.eye_from_scene},
                            .hand_angular_velocity = frame.hand->angular_velocity,
                            .hand_velocity = frame.hand->velocity,
                            .part = frame.part});
  }
  return observations;
}

std::optional<MaximumLikelihoodResult> start_of(const OneStepScene& scene) {
  MaximumLikelihoodOptions likelihood;
  likelihood.noise.hand_rotation_rad = scene.options.hand_rotation_sigma_rad;
  likelihood.noise.hand_translation_mm = scene.options.hand_translation_sigma_mm;
  likelihood.estimate_time_offset = true;
  return maximum_likelihood(observations_of(scene.problem), likelihood);
}

OneStepOptions one_step_options(const OneStepScene& scene, HandNoiseSource source) {
  OneStepOptions result;
  result.lens = scene.lens_prior;
  result.hand_rotation_sigma_rad = scene.options.hand_rotation_sigma_rad;
  result.hand_translation_sigma_mm = scene.options.hand_translation_sigma_mm;
  result.hand_noise = source;
  return result;
}

}  // namespace handeye::synthetic
