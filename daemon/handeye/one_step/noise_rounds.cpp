// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/noise_rounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/geometry/median.hpp"
#include "daemon/geometry/projection.hpp"
#include "daemon/handeye/one_step/hand_term.hpp"
#include "daemon/handeye/one_step/noise_estimate.hpp"

namespace handeye {
namespace {

constexpr double kSettledNoise = 0.02;  // relative change
constexpr int kMostLinearisations = 5;  // at the end
constexpr double kOfNoAccount = 1e-3;   // of the cost: 0.045 sigma
constexpr double kFarthestFocal = 3.0;  // times, either way

bool changes(double from, double to) {
  return std::abs(to - from) > kSettledNoise * from;
}

bool changes(const MetricNoise& from, const MetricNoise& to) {
  return changes(from.image_px, to.image_px) ||
         changes(from.hand_rotation_rad, to.hand_rotation_rad) ||
         changes(from.hand_translation_mm, to.hand_translation_mm) ||
         from.track_weights != to.track_weights;
}

/// Which hands agree with the camera at this noise. Where it was given as less than what most hands
/// show, by what they show.
std::vector<bool> agreeing(const MetricProblem& problem, const MetricNoise& noise) {
  const MetricScene& scene = problem.scene();
  const HandWeights weights =
      hand_weights(scene, problem.eyes(), problem.state(), noise,
                   problem.options().hand_noise == HandNoiseSource::kMeasured);
  std::vector<double> squares;
  std::vector<double> with_hand;
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    squares.push_back(std::numeric_limits<double>::infinity());
    if (!scene.frames[k].hand || weights.whitenings[k].isZero()) continue;
    squares.back() = (weights.whitenings[k] *
                      hand_residual(*scene.frames[k].hand, problem.eyes()[k], problem.state()))
                         .squaredNorm();
    with_hand.push_back(squares.back());
  }
  const double excess =
      with_hand.empty() ? 1.0 : std::max(1.0, median(with_hand) / median_of_squares(6));
  const double most = problem.options().reject * problem.options().reject * excess;
  std::vector<bool> kept;
  for (const double square : squares) kept.push_back(square <= most);
  return kept;
}

bool lens_is_sound(const MetricProblem& problem) {
  if (!problem.lens_free()) return true;
  const CameraModel& camera = problem.state().camera;
  const double ratio = focal_px(camera) / focal_px(problem.scene().start.camera);
  return !camera.problem() && ratio < kFarthestFocal && ratio > 1.0 / kFarthestFocal;
}

/// Equations that were linearised elsewhere may promise too little where little is known: only with
/// equations of its own is a place the minimum, and from no other place is an answer.
bool settle_at_minimum(MetricProblem& problem) {
  auto promised = problem.linearise_anew();
  double lowered = 0;
  for (int again = 0; again < kMostLinearisations && promised; ++again) {
    if (*promised < kSettledPromise) return true;
    const double before = problem.cost();
    if (problem.minimise(problem.noise()) == Minimisation::kNothing) return false;
    if (!lens_is_sound(problem)) return false;
    lowered = std::abs(problem.cost() - before);
    promised = problem.linearise_anew();
  }
  // To and fro about the minimum is at it; creeping, however slowly, is not.
  return promised && *promised < kOfNoAccount && lowered < kOfNoAccount;
}

}  // namespace

bool minimise_with_noise(MetricProblem& problem) {
  MetricNoise noise = noise_at_start(problem.scene(), problem.options());
  for (int round = 1;; ++round) {
    if (problem.minimise(noise) == Minimisation::kNothing || !lens_is_sound(problem)) return false;
    if (round >= problem.options().noise_rounds) break;
    const MetricNoise seen = estimated_noise(problem);
    std::vector<bool> kept = agreeing(problem, seen);
    if (!changes(noise, seen) && kept == problem.kept()) break;
    problem.keep(std::move(kept));
    noise = seen;
  }
  return settle_at_minimum(problem);
}

}  // namespace handeye
