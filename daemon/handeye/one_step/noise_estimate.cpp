// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/noise_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "daemon/geometry/median.hpp"
#include "daemon/handeye/one_step/hand_correlation.hpp"
#include "daemon/handeye/one_step/hand_term.hpp"
#include "daemon/handeye/one_step/track_weights.hpp"

namespace handeye {
namespace {

constexpr int kProbes = 16;
/// Residuals are believed down to this: features err together, however little each seems to, by
/// interpolation, windows seen aslant, a lens that is not quite of the model's kind. On rendered
/// sequences of 20 s, where they are off by 0.03 px, the mean NEES of 6 is 6.9 with 0.1 px and 9.0
/// with 0.05 (seeds 1 to 20, lens given; the errors themselves are alike).
constexpr double kLeastImageNoise_px = 0.1;
/// No tracker is better than that.
constexpr double kLeastRotation_rad = 1e-5;
constexpr double kLeastTranslation_mm = 2e-3;

constexpr double kLeastLeft = 0.2;  // of the residuals' freedom

double square(double x) {
  return x * x;
}

double standard_deviation(double variance, double least) {
  return std::sqrt(std::max(variance, square(least)));
}

/// One kind of error, rotation or translation, over all hands.
class Component {
 public:
  explicit Component(double variance) : variance_(variance) {}

  /// `share`: of three axes, by which interpolation lowers the variance; `other`: variance that is
  /// not the tracker's; `taken`: that the solution took up. Residuals weighted.
  void add(double residual_square, double share, double other, double taken) {
    const double weight = 1.0 / square(share * variance_ + other / 3.0);
    squares_ += weight * (residual_square - other);
    taken_ += weight * taken;
    expected_ += weight * 3.0 * share;
  }

  /// A sample's variance that the squares, without what was taken up of it, are as expected of.
  /// What was taken up counts in proportion to the variance sought, else, where it is nearly all,
  /// as it was: both agree in the end, the first much sooner (Harville 1977).
  double variance() const {
    const double left = expected_ - taken_ / variance_;
    return left > kLeastLeft * expected_ ? squares_ / left : (squares_ + taken_) / expected_;
  }

 private:
  double variance_;     ///< of a sample, as was assumed
  double squares_{0};   ///< of residuals, without what is not the tracker's; weighted
  double taken_{0};     ///< weighted alike
  double expected_{0};  ///< for a sample's variance of 1
};

/// P values, P = J H^-1 J^T: what the solution takes up of errors of the hand rows, whitened; a
/// column each.
Eigen::MatrixXd taken_up(const MetricProblem& problem, const Eigen::MatrixXd& errors) {
  const std::vector<HandRow>& rows = problem.hand_rows();
  MetricColumns right = problem.equations().zero(errors.cols());
  for (Eigen::Index column = 0; column < errors.cols(); ++column) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k].add_gradient(problem.scene(),
                           errors.col(column).segment<6>(6 * static_cast<Eigen::Index>(k)), right,
                           column);
    }
  }
  const MetricColumns answers = problem.equations().solve(right);
  Eigen::MatrixXd taken(errors.rows(), errors.cols());
  for (Eigen::Index column = 0; column < errors.cols(); ++column) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      taken.col(column).segment<6>(6 * static_cast<Eigen::Index>(k)) =
          rows[k].change(problem.scene(), answers, column);
    }
  }
  return taken;
}

/// S errors: of frames that share samples of the tracker, the others' by what they share.
Eigen::MatrixXd with_neighbours(const MetricProblem& problem, const Eigen::MatrixXd& errors) {
  const std::vector<HandRow>& rows = problem.hand_rows();
  const std::vector<MetricFrame>& frames = problem.scene().frames;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(errors.rows(), errors.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t other = k + 1; other < rows.size(); ++other) {
      if (!share_samples(*frames[rows[k].frame].hand, *frames[rows[other].frame].hand)) break;
      const Matrix6d shared = shared_covariance(problem, rows[k], rows[other]);
      const Eigen::Index at = 6 * static_cast<Eigen::Index>(k);
      const Eigen::Index at_other = 6 * static_cast<Eigen::Index>(other);
      sum.middleRows<6>(at) += shared * errors.middleRows<6>(at_other);
      sum.middleRows<6>(at_other) += shared.transpose() * errors.middleRows<6>(at);
    }
  }
  return sum;
}

}  // namespace

Leverage hand_leverage(const MetricProblem& problem) {
  const std::vector<HandRow>& rows = problem.hand_rows();
  const auto n = static_cast<Eigen::Index>(rows.size());
  std::mt19937 generator(1);
  Eigen::MatrixXd probes(6 * n, kProbes);
  for (Eigen::Index i = 0; i < probes.size(); ++i) {
    probes(i) = (generator() & 1U) != 0 ? 1.0 : -1.0;
  }
  const Eigen::MatrixXd taken = taken_up(problem, probes);
  // Of errors that frames share more is taken up: with covariance I + S it is P + 2 P S - P S P.
  Eigen::MatrixXd shared = with_neighbours(problem, probes);
  if (!shared.isZero(0)) shared = taken_up(problem, shared);
  Leverage leverage;
  leverage.variances.assign(rows.size(), Vector6d::Zero());
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const auto root =
        problem.hands().weights.whitenings[rows[at].frame].triangularView<Eigen::Lower>();
    for (int probe = 0; probe < kProbes; ++probe) {
      const Vector6d z = probes.col(probe).segment<6>(6 * k);
      const Vector6d pz = taken.col(probe).segment<6>(6 * k);
      const Vector6d psz = shared.col(probe).segment<6>(6 * k);
      leverage.whitened += (z.dot(pz + 2.0 * psz) - pz.dot(psz)) / kProbes;
      leverage.variances[at] += (root.solve(z).cwiseProduct(root.solve(pz + 2.0 * psz)) -
                                 root.solve(pz).cwiseProduct(root.solve(psz))) /
                                kProbes;
    }
  }
  return leverage;
}

MetricNoise noise_at_start(const MetricScene& scene, const OneStepOptions& options) {
  MetricNoise noise{std::max(options.image_noise_px.value_or(0), kLeastImageNoise_px),
                    options.hand_rotation_sigma_rad, options.hand_translation_sigma_mm};
  if (!options.image_noise_px) {
    const double n = 2.0 * static_cast<double>(scene.observations.size());
    const double freedom = std::max(1.0, n - 3.0 * static_cast<double>(scene.points()) -
                                             6.0 * static_cast<double>(scene.keyframes()));
    std::vector<double> norms = error_norms(scene, scene.start);
    noise.image_px = standard_deviation(square(median(norms)) / median_of_squares(2) * n / freedom,
                                        kLeastImageNoise_px);
  }
  if (options.hand_noise != HandNoiseSource::kEstimated) return noise;
  const std::vector<Pose> eyes = eyes_at_start(scene);
  std::vector<double> rotations;
  std::vector<double> translations;
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    if (!scene.frames[k].hand) continue;
    const HandAtFrame& hand = *scene.frames[k].hand;
    const Vector6d residual = hand_residual(hand, eyes[k], scene.start);
    const double share = interpolated_variance(hand);
    rotations.push_back(residual.head<3>().squaredNorm() / share);
    translations.push_back(residual.tail<3>().squaredNorm() / share);
  }
  const double usual = median_of_squares(3);
  noise.hand_rotation_rad = standard_deviation(median(rotations) / usual, kLeastRotation_rad);
  noise.hand_translation_mm =
      standard_deviation(median(translations) / usual, kLeastTranslation_mm);
  return noise;
}

double image_freedom(const MetricProblem& problem) {
  const MetricScene& scene = problem.scene();
  const double unknowns = 3.0 * static_cast<double>(scene.points()) +
                          6.0 * static_cast<double>(scene.keyframes()) +
                          (problem.lens_free() ? kLensParameters : 0);
  return std::max(1.0, 2.0 * static_cast<double>(scene.observations.size()) - unknowns);
}

double image_noise_seen_px(const MetricProblem& problem) {
  if (problem.options().image_noise_px) return *problem.options().image_noise_px;
  return std::sqrt(problem.robust_image_squares() / image_freedom(problem));
}

MetricNoise estimated_noise(const MetricProblem& problem) {
  const OneStepOptions& options = problem.options();
  MetricNoise noise = problem.noise();
  const double image_px = image_noise_seen_px(problem);
  noise.image_px = std::max(image_px, kLeastImageNoise_px);
  std::vector<double> weights = track_weights(problem.scene(), problem.image_rows(), image_px);
  if (differ(weights, noise.track_weights)) noise.track_weights = std::move(weights);
  if (options.hand_noise != HandNoiseSource::kEstimated) return noise;
  const MetricScene& scene = problem.scene();
  const Leverage leverage = hand_leverage(problem);
  const std::vector<double> scales = scales_since_start(scene, problem.state());
  const std::vector<HandRow>& rows = problem.hand_rows();
  Component rotation(square(problem.noise().hand_rotation_rad));
  Component translation(square(problem.noise().hand_translation_mm));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const MetricFrame& frame = scene.frames[rows[i].frame];
    const Pose& eye = problem.eyes()[rows[i].frame];
    const Vector6d residual = hand_residual(*frame.hand, eye, problem.state());
    const double weight = rows[i].weight / problem.share_of_hand_squares();
    // What is not the tracker's is so by as much as was seen, not by what is allowed for.
    const Vector6d other =
        square(image_px) *
        eye_noise_at_hand(frame, eye, problem.state(), scales[frame.part]).diagonal();
    const double share = interpolated_variance(*frame.hand);
    const Vector6d& taken = leverage.variances[i];
    rotation.add(weight * residual.head<3>().squaredNorm(), share, other.head<3>().sum(),
                 taken.head<3>().sum());
    translation.add(weight * residual.tail<3>().squaredNorm(), share, other.tail<3>().sum(),
                    taken.tail<3>().sum());
  }
  noise.hand_rotation_rad = standard_deviation(rotation.variance(), kLeastRotation_rad);
  noise.hand_translation_mm = standard_deviation(translation.variance(), kLeastTranslation_mm);
  return noise;
}

}  // namespace handeye
