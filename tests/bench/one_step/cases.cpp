// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/one_step/cases.hpp"

#include "tests/unit/handeye/one_step_motions.hpp"

namespace handeye::bench {
namespace {

using synthetic::OneStepSceneOptions;

/// The experiment of docs/math.md section 8: every frame a keyframe.
OneStepSceneOptions all_keyframes(int frames, std::optional<IntrinsicsMode> lens) {
  OneStepSceneOptions options;
  options.tracks.frames = frames;
  options.keyframe_interval = 1;
  options.lens = lens;
  return options;
}

}  // namespace

std::vector<OneStepCase> one_step_cases() {
  const OneStepSceneOptions plain;
  OneStepSceneOptions lens;
  lens.lens = IntrinsicsMode::kEstimate;
  OneStepSceneOptions quiet;
  quiet.hand_rotation_sigma_rad = rad_from_deg(0.06);
  quiet.hand_translation_sigma_mm = 0.15;
  OneStepSceneOptions slow_tracker;
  slow_tracker.tracker_hz = 30;
  slow_tracker.tracks.rate_hz = 60;
  slow_tracker.tracks.frames = 240;
  slow_tracker.keyframe_interval = 8;
  OneStepSceneOptions outliers;
  outliers.outlier_samples = 0.05;
  OneStepSceneOptions drifting;
  drifting.tracks.noise_memory_s = 0.4;
  OneStepSceneOptions bad_tracks;
  bad_tracks.tracks.bad_tracks = 0.1;
  OneStepSceneOptions bad_tracks_all = all_keyframes(150, std::nullopt);
  bad_tracks_all.tracks.bad_tracks = 0.1;
  OneStepSceneOptions smooth;
  smooth.smooth_hands = true;
  OneStepSceneOptions smooth_all = all_keyframes(150, std::nullopt);
  smooth_all.smooth_hands = true;
  OneStepSceneOptions parts;
  parts.tracks.parts = 3;
  parts.tracks.frames = 180;
  OneStepSceneOptions varying;
  varying.hand_noise_varies = true;
  OneStepSceneOptions trocar;
  trocar.tracks.motion =
      synthetic::shaped_motion({{20, 20, 20}, {0, 0, 15}, synthetic::kTrocar_mm});
  return {
      {"plain", plain},
      {"plain-given", plain, HandNoiseSource::kGiven},
      {"lens", lens},
      {"quiet-tracker", quiet},
      {"slow-tracker", slow_tracker, HandNoiseSource::kEstimated, 10},
      {"outliers", outliers},
      {"drifting-tracks", drifting},
      {"bad-tracks", bad_tracks},
      {"150-keyframes-bad-tracks", bad_tracks_all},
      {"smooth", smooth},
      {"150-keyframes-smooth", smooth_all},
      {"parts", parts},
      {"varying-given", varying, HandNoiseSource::kGiven},
      {"varying-estimated", varying, HandNoiseSource::kEstimated},
      {"varying-measured", varying, HandNoiseSource::kMeasured},
      {"trocar-slide", trocar},
      {"150-keyframes", all_keyframes(150, std::nullopt)},
      {"150-keyframes-lens", all_keyframes(150, IntrinsicsMode::kEstimate)},
      {"600-keyframes", all_keyframes(600, std::nullopt), HandNoiseSource::kEstimated, 10, 10},
  };
}

}  // namespace handeye::bench
