// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/metric_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/handeye/one_step/hand_term.hpp"

namespace handeye {
namespace {

constexpr int kImageDimensions = 2;
constexpr int kHandDimensions = 6;
constexpr double kMaxDamping = 1e6;  // no step is small enough
constexpr double kFirstDamping = 1e-3;
constexpr double kSlow = 0.1;  // of a promise to the one before: linearise anew

/// So much more cost is none: what frames do that follow is known to first order only, and where
/// the gradient is zero, not where the cost's last digit is least, is the minimum.
constexpr double kNoIncrease = 0.1;
/// Where hardly anything but the scale is wrong, a step along it bends: the images fall ill and are
/// well again a step later. Damped steps would creep (watchdog: Chamberlain et al. 1982).
constexpr int kMostUphill = 3;
constexpr double kNearNoise = 0.1;  // relative: the equations still point the right way

double square(double x) {
  return x * x;
}

bool is_near(double a, double b) {
  return std::abs(a - b) < kNearNoise * b;
}

bool are_near(const MetricNoise& a, const MetricNoise& b) {
  return is_near(a.image_px, b.image_px) && is_near(a.hand_rotation_rad, b.hand_rotation_rad) &&
         is_near(a.hand_translation_mm, b.hand_translation_mm);
}

}  // namespace

MetricProblem::MetricProblem(const MetricScene& scene, const OneStepOptions& options)
    : scene_(scene),
      options_(options),
      state_(scene.start),
      huber_of_image_(huber_norm(kImageDimensions, options.huber)),
      huber_of_hand_(huber_norm(kHandDimensions, options.huber)),
      equations_(scene, options_) {
  for (const MetricFrame& frame : scene.frames) hands_.kept.push_back(frame.hand.has_value());
  hands_.huber = huber_of_hand_.norm;
  here_.eyes = eyes_at_start(scene);
}

double MetricProblem::robust_image_squares() const {
  return here_.rows.weighted_squares / huber_of_image_.share_of_squares;
}

double MetricProblem::prior_cost(const MetricState& state) const {
  double cost = 0;
  if (options_.estimate_time_offset) {
    cost += 0.5 * square(state.time_offset_s / options_.time_offset_prior_s);
  }
  if (lens_free()) {
    const LensVector off = lens_vector(state.camera) - options_.lens->mean;
    cost += 0.5 * off.cwiseQuotient(options_.lens->sigma).squaredNorm();
  }
  return cost;
}

bool MetricProblem::evaluate(const MetricState& state, Place& place) const {
  const double huber_px = huber_of_image_.norm * noise_.image_px;
  if (!linearise(scene_, state, noise_.track_weights, huber_px, lens_free(), place.rows)) {
    return false;
  }
  if (scene_.has_followers()) place.sighted = keyframes_by_sight(scene_, state, place.rows);
  const std::vector<Pose>& at_start = sighted_at_start_.empty() ? place.sighted : sighted_at_start_;
  place.eyes = eyes_of_frames(scene_, state, at_start, place.sighted);
  place.cost = place.rows.cost / square(noise_.image_px) +
               hand_cost(scene_, state, place.eyes, hands_) + prior_cost(state);
  return std::isfinite(place.cost);
}

MetricColumns MetricProblem::gradient() const {
  MetricColumns sum = equations_.zero(1);
  for (const HandRow& row : hand_rows_) row.add_gradient(scene_, row.residual, sum, 0);
  auto of_unknowns = sum.of_unknowns.col(0);
  if (options_.estimate_time_offset) {
    of_unknowns[scene_.common_at() + kTimeInCommon] +=
        state_.time_offset_s / square(options_.time_offset_prior_s);
  }
  if (lens_free()) {
    const LensVector off = lens_vector(state_.camera) - options_.lens->mean;
    of_unknowns.tail<kLensParameters>() +=
        off.cwiseQuotient(options_.lens->sigma.cwiseProduct(options_.lens->sigma));
  }
  return sum;
}

bool MetricProblem::factorise(double damping) {
  factor_noise_.reset();
  if (damping == 0) factor_noise_ = noise_;
  return equations_.factorise(hand_rows_, noise_.image_px, damping);
}

void MetricProblem::eliminate_points() {
  equations_.linearise(here_.rows);
  eliminated_ = at_elimination_ = true;
}

void MetricProblem::set_noise(MetricNoise noise) {
  if (noise.track_weights.empty()) noise.track_weights.assign(scene_.points(), 1.0);
  // The images' equations were linearised with the old weights.
  if (noise.track_weights != noise_.track_weights) eliminated_ = false;
  noise_ = std::move(noise);
  hands_.weights = hand_weights(scene_, here_.eyes, state_, noise_,
                                options_.hand_noise == HandNoiseSource::kMeasured);
}

bool MetricProblem::retreat(double& damping) {
  const bool back = least_.has_value();
  if (back) state_ = std::exchange(least_, std::nullopt)->state;
  if (at_elimination_ || back) damping = std::max(10.0 * damping, kFirstDamping);
  eliminated_ = at_elimination_ && !back;
  // The rows went into the elimination: they are wanted again.
  return evaluate(state_, here_);
}

Minimisation MetricProblem::minimise(MetricNoise noise) {
  set_noise(std::move(noise));
  if (!evaluate(state_, here_)) return Minimisation::kNothing;
  // The first time is at the start.
  if (sighted_at_start_.empty()) sighted_at_start_ = here_.sighted;
  at_elimination_ = false;
  bool factorised = eliminated_ && factor_noise_ && are_near(*factor_noise_, noise_);
  double damping = 0;
  double promised_before = 0;
  int uphill = 0;
  least_.reset();
  for (int i = 0; i < options_.max_iterations && damping <= kMaxDamping; ++i) {
    hand_rows_ = handeye::hand_rows(scene_, state_, here_.eyes, hands_);
    const ImageGradient of_images = gradient_of(scene_, here_.rows, lens_free());
    if (!eliminated_) eliminate_points();
    if (!factorised && !factorise(damping)) return Minimisation::kNothing;
    factorised = true;

    const NormalEquations::Step step = equations_.step(of_images, gradient());
    if (!step.of_unknowns.allFinite()) return Minimisation::kNothing;
    const double promised = step.promised;
    // A damped step promises little wherever it is taken from.
    const bool at_rest = promised < kSettledPromise && damping == 0;
    if (at_rest && !least_) return Minimisation::kSettled;
    ++iterations_;
    MetricState tried = moved_by(state_, step.of_unknowns, step.of_points);
    // Where it rests up the hill is another minimum.
    const bool possible = !at_rest && evaluate(tried, next_);
    const double least = least_ ? least_->cost : here_.cost;
    const bool lower = possible && next_.cost < least + kNoIncrease;
    if (lower || (possible && damping == 0 && uphill < kMostUphill)) {
      if (!lower && !least_) least_ = Stand{state_, here_.cost};
      if (lower) least_.reset();
      uphill = lower ? 0 : uphill + 1;
      state_ = std::move(tried);
      std::swap(here_, next_);
      // Far from where they were linearised the equations point the wrong way, or not far enough.
      if (!lower || (promised_before > 0 && promised > kSlow * promised_before)) {
        eliminated_ = false;
      }
      factorised = factorised && eliminated_ && damping == 0;
      at_elimination_ = false;
      damping = damping > kFirstDamping ? 0.1 * damping : 0;
      promised_before = promised;
    } else {
      factorised = false;
      if (!retreat(damping)) return Minimisation::kNothing;
    }
  }
  if (least_ && !retreat(damping)) return Minimisation::kNothing;
  return Minimisation::kUnsettled;
}

std::optional<double> MetricProblem::linearise_anew() {
  if (!evaluate(state_, here_)) return std::nullopt;
  hand_rows_ = handeye::hand_rows(scene_, state_, here_.eyes, hands_);
  const ImageGradient of_images = gradient_of(scene_, here_.rows, lens_free());
  eliminate_points();
  if (!factorise(0)) return std::nullopt;
  const NormalEquations::Step step = equations_.step(of_images, gradient());
  if (!step.of_unknowns.allFinite()) return std::nullopt;
  return step.promised;
}

}  // namespace handeye
