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
constexpr double kSettled = 1e-4;    // decrease of the cost still promised: 0.01 sigma of a step
constexpr double kMaxDamping = 1e6;  // no step is small enough
constexpr double kFirstDamping = 1e-3;
constexpr double kSlow = 0.1;  // of a promise to the one before: linearise anew

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
      elimination_(scene) {
  for (const MetricFrame& frame : scene.frames) hands_.kept.push_back(frame.hand.has_value());
  hands_.huber = huber_of_hand_.norm;
}

bool MetricProblem::estimates(Eigen::Index common) const {
  if (common == kTimeInCommon) return options_.estimate_time_offset;
  return common < kLensInCommon || lens_free();
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
  if (!linearise(scene_, state, huber_px, lens_free(), place.rows)) return false;
  place.eyes = eyes_of_frames(scene_, state);
  place.cost = place.rows.cost / square(noise_.image_px) +
               hand_cost(scene_, state, place.eyes, hands_) + prior_cost(state);
  return std::isfinite(place.cost);
}

void MetricProblem::add_priors(Eigen::VectorXd& gradient) const {
  const Eigen::Index common = scene_.common_at();
  if (options_.estimate_time_offset) {
    gradient[common + kTimeInCommon] += state_.time_offset_s / square(options_.time_offset_prior_s);
  }
  if (lens_free()) {
    const LensVector off = lens_vector(state_.camera) - options_.lens->mean;
    gradient.tail<kLensParameters>() +=
        off.cwiseQuotient(options_.lens->sigma.cwiseProduct(options_.lens->sigma));
  }
}

void MetricProblem::hold(Eigen::VectorXd& gradient) const {
  for (Eigen::Index i = 0; i < kCommonUnknowns; ++i) {
    if (!estimates(i)) gradient[scene_.common_at() + i] = 0;
  }
}

bool MetricProblem::factorise(double damping) {
  Eigen::MatrixXd information = elimination_.information() / square(noise_.image_px);
  for (const HandRow& row : hand_rows_) row.add_information(scene_, information);
  const Eigen::Index common = scene_.common_at();
  if (options_.estimate_time_offset) {
    information(common + kTimeInCommon, common + kTimeInCommon) +=
        1.0 / square(options_.time_offset_prior_s);
  }
  for (Eigen::Index i = 0; i < kLensParameters && lens_free(); ++i) {
    const Eigen::Index at = common + kLensInCommon + i;
    information(at, at) += 1.0 / square(options_.lens->sigma[i]);
  }
  for (Eigen::Index i = common; i < scene_.unknowns(); ++i) {
    if (estimates(i - common)) continue;
    information.row(i).head(i).setZero();
    information.col(i).tail(scene_.unknowns() - i - 1).setZero();
    information(i, i) = 1;
  }
  information.diagonal() *= 1.0 + damping;
  factor_.compute(information);
  factor_noise_.reset();
  if (damping == 0) factor_noise_ = noise_;
  return factor_.info() == Eigen::Success;
}

void MetricProblem::eliminate_points() {
  elimination_.eliminate(here_.rows, lens_free());
  eliminated_ = at_elimination_ = true;
}

void MetricProblem::set_noise(const MetricNoise& noise) {
  noise_ = noise;
  hands_.weights = hand_weights(scene_, eyes_of_frames(scene_, state_), state_, noise,
                                options_.hand_noise == HandNoiseSource::kMeasured);
}

bool MetricProblem::minimise(MetricNoise noise) {
  set_noise(noise);
  if (!evaluate(state_, here_)) return false;
  at_elimination_ = false;
  bool factorised = eliminated_ && factor_noise_ && are_near(*factor_noise_, noise_);
  double damping = 0;
  double promised_before = 0;
  for (int i = 0; i < options_.max_iterations; ++i) {
    hand_rows_ = handeye::hand_rows(scene_, state_, here_.eyes, hands_);
    const ImageGradient of_images = gradient_of(scene_, here_.rows, lens_free());
    if (!eliminated_) eliminate_points();
    if (!factorised && !factorise(damping)) return false;
    factorised = true;

    const double weight = 1.0 / square(noise_.image_px);
    Eigen::VectorXd gradient = weight * elimination_.reduced(of_images);
    for (const HandRow& row : hand_rows_) row.add_gradient(scene_, row.residual, gradient);
    add_priors(gradient);
    hold(gradient);
    const Eigen::VectorXd step = -factor_.solve(gradient);
    if (!step.allFinite()) return false;
    const double promised =
        -0.5 * gradient.dot(step) + weight * elimination_.promised_by_points(of_images);
    if (promised < kSettled) break;
    ++iterations_;
    const MetricState tried = moved_by(state_, step, elimination_.point_steps(of_images, step));
    if (evaluate(tried, next_) && next_.cost < here_.cost) {
      state_ = tried;
      std::swap(here_, next_);
      // Far from where they were linearised the equations point the wrong way, or not far enough.
      if (promised_before > 0 && promised > kSlow * promised_before) eliminated_ = false;
      factorised = factorised && eliminated_ && damping == 0;
      at_elimination_ = false;
      damping = damping > kFirstDamping ? 0.1 * damping : 0;
      promised_before = promised;
    } else {
      if (damping > kMaxDamping) break;
      if (at_elimination_) damping = std::max(10.0 * damping, kFirstDamping);
      eliminated_ = at_elimination_;
      factorised = false;
      // The rows went into the elimination: they are wanted again.
      if (!evaluate(state_, here_)) return false;
    }
  }
  return true;
}

bool MetricProblem::linearise_anew() {
  if (!evaluate(state_, here_)) return false;
  hand_rows_ = handeye::hand_rows(scene_, state_, here_.eyes, hands_);
  eliminate_points();
  return factorise(0);
}

}  // namespace handeye
