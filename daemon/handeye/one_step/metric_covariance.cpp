// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/metric_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

#include "daemon/handeye/one_step/hand_correlation.hpp"
#include "daemon/handeye/one_step/noise_estimate.hpp"
#include "daemon/handeye/one_step/path_scale.hpp"

namespace handeye {
namespace {

constexpr double kChance = 2.0;  // standard deviations of the tracks' spread

using RowByCommon = Eigen::Matrix<double, 6, kCommonUnknowns>;

/// What the tracker's errors, whitened, move the common unknowns by.
std::vector<RowByCommon> answers_to_hands(const MetricProblem& problem,
                                          const MetricColumns& by_common) {
  std::vector<RowByCommon> answers;
  answers.reserve(problem.hand_rows().size());
  for (const HandRow& row : problem.hand_rows()) {
    RowByCommon& answer = answers.emplace_back();
    for (Eigen::Index i = 0; i < kCommonUnknowns; ++i) {
      answer.col(i) = row.change(problem.scene(), by_common, i);
    }
  }
  return answers;
}

/// How much of `of_hands` is not the tracker's, but of the resection of frames that follow.
CommonMatrix resected_part(const MetricProblem& problem, const std::vector<RowByCommon>& answers) {
  const bool measured = problem.options().hand_noise == HandNoiseSource::kMeasured;
  CommonMatrix sum = CommonMatrix::Zero();
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const std::size_t at = problem.hand_rows()[k].frame;
    const MetricFrame& frame = problem.scene().frames[at];
    if (frame.keyframe) continue;
    const Matrix6d& whitening = problem.hands().weights.whitenings[at];
    const Matrix6d of_tracker = interpolated_variance(*frame.hand) * whitening *
                                sample_covariance(*frame.hand, problem.noise(), measured) *
                                whitening.transpose();
    sum += answers[k].transpose() * (Matrix6d::Identity() - of_tracker) * answers[k];
  }
  return sum;
}

/// What frames that share samples add.
CommonMatrix shared_part(const MetricProblem& problem, const std::vector<RowByCommon>& answers) {
  const std::vector<HandRow>& rows = problem.hand_rows();
  const std::vector<MetricFrame>& frames = problem.scene().frames;
  CommonMatrix sum = CommonMatrix::Zero();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const HandAtFrame& hand = *frames[rows[k].frame].hand;
    for (std::size_t other = k + 1; other < rows.size(); ++other) {
      if (!share_samples(hand, *frames[rows[other].frame].hand)) break;
      const CommonMatrix product = answers[k].transpose() *
                                   shared_covariance(problem, rows[k], rows[other]) *
                                   answers[other];
      sum += product + product.transpose();
    }
  }
  return sum;
}

/// Noise that was given is believed within what chance explains; beyond it, by how much is it
/// exceeded.
double excess(const MetricProblem& problem, double freedom) {
  if (problem.options().hand_noise == HandNoiseSource::kEstimated) return 1.0;
  double chi2 = 0;
  for (const HandRow& row : problem.hand_rows()) chi2 += row.residual.squaredNorm();
  chi2 /= freedom * problem.share_of_hand_squares();
  return chi2 > 1.0 + 3.3 * std::sqrt(2.0 / freedom) ? chi2 : 1.0;
}

/// What the priors contribute.
CommonMatrix prior_part(const MetricProblem& problem, const CommonMatrix& base) {
  CommonMatrix sum = CommonMatrix::Zero();
  const auto add = [&](Eigen::Index i, double sigma) {
    sum += base.col(i) * base.col(i).transpose() / (sigma * sigma);
  };
  if (problem.options().estimate_time_offset) {
    add(kTimeInCommon, problem.options().time_offset_prior_s);
  }
  if (problem.lens_free()) {
    for (Eigen::Index i = 0; i < kLensParameters; ++i) {
      add(kLensInCommon + i, problem.options().lens->sigma[i]);
    }
  }
  return sum;
}

/// What the errors along whole tracks, as they were, move the common unknowns by. A track's
/// residuals are smaller than its errors by what the solution took up of them, on average by
/// freedom over errors. The whole factor makes them good, as leaving out a track at a time would
/// (CR3), not its root, which suits independent errors (CR2; Bell & McCaffrey 2002): these count
/// only where errors agree along tracks, and there more is taken up than on average. NEES of 6 is
/// 8.65 then, with the root 9.55 (100 seeds of `one_step_table drifting-tracks`).
std::vector<CommonVector> pulls_of_tracks(const MetricProblem& problem,
                                          const MetricColumns& by_common) {
  const MetricScene& scene = problem.scene();
  const double errors = 2.0 * static_cast<double>(scene.observations.size()) -
                        3.0 * static_cast<double>(scene.points());
  const double taken = std::max(1.0, errors / image_freedom(problem));
  std::vector<CommonVector> pulls = problem.equations().pulls_of_points(by_common);
  for (CommonVector& pull : pulls) pull *= taken;
  return pulls;
}

/// The covariance of the unknowns listed, widened in every direction to what it is when the images'
/// part comes from whole tracks, where that is more than chance in the number of tracks; zero
/// elsewhere. `resected`: the part of frames that follow. Their images show the same tracks, so
/// that where errors agree along these, theirs add to the keyframes', as errors and not as
/// variances.
CommonMatrix widened_by_tracks(const CommonMatrix& covariance, const CommonMatrix& of_images,
                               const CommonMatrix& resected, const std::vector<CommonVector>& pulls,
                               const std::vector<Eigen::Index>& listed) {
  CommonMatrix spread = CommonMatrix::Zero();
  for (const CommonVector& pull : pulls) spread += pull * pull.transpose();
  const Eigen::MatrixXd base = covariance(listed, listed);
  const CommonMatrix more = spread - of_images;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(more(listed, listed).eval(),
                                                                        base);
  Eigen::VectorXd factors = Eigen::VectorXd::Ones(base.rows());
  for (Eigen::Index i = 0; i < factors.size(); ++i) {
    double fourth_powers = 0;
    for (const CommonVector& pull : pulls) {
      fourth_powers += std::pow(pull(listed).dot(eigen.eigenvectors().col(i)), 4);
    }
    // Of a sum of squared normal deviates.
    const double chance = kChance * std::sqrt(2.0 / 3.0 * fourth_powers);
    const double excess = eigen.eigenvalues()[i];
    if (excess <= chance) continue;
    const auto along = [&](const CommonMatrix& part) {
      const Eigen::VectorXd direction = eigen.eigenvectors().col(i);
      return direction.dot(part(listed, listed) * direction);
    };
    factors[i] += excess * std::pow(1.0 + std::sqrt(along(resected) / along(of_images)), 2);
  }
  const Eigen::MatrixXd directions = base * eigen.eigenvectors();
  CommonMatrix result = CommonMatrix::Zero();
  result(listed, listed) = directions * factors.asDiagonal() * directions.transpose();
  return result;
}

/// By how much honesty widened the variance of hand_from_eye where it did most.
double most_widened(const CommonMatrix& base, const CommonMatrix& covariance) {
  const Matrix6d before = base.topLeftCorner<6, 6>();
  const Matrix6d after = covariance.topLeftCorner<6, 6>();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> ratios(after, before,
                                                                  Eigen::EigenvaluesOnly);
  return std::max(1.0, ratios.eigenvalues().maxCoeff());
}

}  // namespace

MetricCovariance metric_covariance(const MetricProblem& problem, double hand_freedom) {
  MetricColumns unit = problem.equations().zero(kCommonUnknowns);
  unit.of_unknowns.bottomRows<kCommonUnknowns>().setIdentity();
  const MetricColumns by_common = problem.equations().solve(unit);
  const CommonMatrix base = by_common.of_unknowns.bottomRows<kCommonUnknowns>();

  const std::vector<RowByCommon> answers = answers_to_hands(problem, by_common);
  CommonMatrix of_hands = CommonMatrix::Zero();
  for (const RowByCommon& answer : answers) of_hands += answer.transpose() * answer;
  const CommonMatrix of_images = base - of_hands - prior_part(problem, base);

  MetricCovariance result;
  result.correlation_inflation = correlation_beyond_samples(problem);
  const double inflation = result.correlation_inflation * excess(problem, hand_freedom);
  const CommonMatrix of_independent_tracks =
      base - of_hands + inflation * (of_hands + shared_part(problem, answers));
  std::vector<Eigen::Index> estimated;
  for (Eigen::Index i = 0; i < kCommonUnknowns; ++i) {
    if (problem.estimates(i)) estimated.push_back(i);
  }
  const double followers = static_cast<double>(problem.scene().frames.size()) /
                               static_cast<double>(problem.scene().keyframes()) -
                           1.0;
  result.covariance = widened_by_tracks(of_independent_tracks, of_images,
                                        followers * resected_part(problem, answers),
                                        pulls_of_tracks(problem, by_common), estimated);
  result.log_scale_sigma =
      std::sqrt(log_scale_variance(problem) * most_widened(base, result.covariance));
  return result;
}

}  // namespace handeye
