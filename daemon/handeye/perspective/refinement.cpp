// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/refinement.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "daemon/handeye/perspective/projection_problem.hpp"

namespace handeye {
namespace {

using Hands = ProjectionProblem::Hands;

constexpr double kExactImages_px = 1e-7;  // below it the residuals are rounding
constexpr double kPriorCount = 3.0;       // so many values' worth is the first guess of hand noise
constexpr int kNoiseRounds = 20;

/// Variance of what is left over by so many unknowns.
double variance(double sum_of_squares, Eigen::Index residuals, Eigen::Index unknowns) {
  return sum_of_squares / static_cast<double>(std::max<Eigen::Index>(residuals - unknowns, 1));
}

/// Whether exact hands leave more than the image noise explains (F test, beyond any chance).
bool contradicts(double exact_sum, double free_sum, Eigen::Index exact_unknowns,
                 Eigen::Index free_unknowns, Eigen::Index residuals) {
  if (std::sqrt(exact_sum / static_cast<double>(residuals)) < kExactImages_px) return false;
  const auto more = static_cast<double>(free_unknowns - exact_unknowns);
  const double f = (exact_sum - free_sum) / more / variance(free_sum, residuals, free_unknowns);
  return f > 1.0 + 4.0 * std::sqrt(2.0 / more);
}

/// The hand's noise that alone would make residuals of this size: where estimating it starts.
HandNoise hand_noise_behind(double reprojection_px, const RefinedCalibration& calibration) {
  const double focal_px = 0.5 * (calibration.camera.fx + calibration.camera.fy);
  const double angle_rad = reprojection_px / focal_px;
  const double distance_mm =
      (calibration.object_from_hand * calibration.hand_from_eye).translation().norm();
  return {angle_rad, angle_rad * std::max(distance_mm, 1.0)};
}

/// Alternates between the unknowns and the hand's noise until both settle.
bool solve_with_hand_noise(ProjectionProblem& problem, double image_noise_px, HandNoise& noise) {
  const HandNoise guess = noise;
  // Of the 3n values of each kind X and Y take six.
  const auto freedom = static_cast<double>(3 * problem.positions() - 6);
  for (int round = 0; round < kNoiseRounds; ++round) {
    if (!problem.solve(Hands::kNoisy, image_noise_px, noise)) return false;
    const Eigen::Vector2d sum = problem.sum_of_square_deviations();
    const auto estimate = [&](double square, double guessed) {
      return std::sqrt((kPriorCount * guessed * guessed + square) / (kPriorCount + freedom));
    };
    const HandNoise next{estimate(sum(0), guess.rotation_rad),
                         estimate(sum(1), guess.translation_mm)};
    const double change = std::max(std::abs(next.rotation_rad / noise.rotation_rad - 1.0),
                                   std::abs(next.translation_mm / noise.translation_mm - 1.0));
    noise = next;
    constexpr double kSettled = 1e-3;
    if (change < kSettled) break;
  }
  return problem.solve(Hands::kNoisy, image_noise_px, noise);
}

PerspectiveSigma sigma_of(const Eigen::MatrixXd& covariance, bool distortion_inside) {
  const auto of_block = [&](Eigen::Index at) {
    return std::sqrt(covariance.diagonal().segment<3>(at).sum());
  };
  const auto of = [&](Eigen::Index at) { return std::sqrt(covariance(at, at)); };
  return {.object_from_hand_deg = deg_from_rad(of_block(0)),
          .object_from_hand_mm = of_block(3),
          .hand_from_eye_deg = deg_from_rad(of_block(6)),
          .hand_from_eye_mm = of_block(9),
          .camera = {of(12), of(13), of(14), of(15), distortion_inside ? of(16) : 0.0}};
}

}  // namespace

bool can_begin(const Observations& observations, const RefinedCalibration& start,
               bool distortion_inside) {
  return ProjectionProblem(observations, start, distortion_inside).errors_px().has_value();
}

std::optional<Refinement> refine(const Observations& observations, const RefinedCalibration& start,
                                 bool distortion_inside) {
  ProjectionProblem problem(observations, start, distortion_inside);
  if (!problem.solve(Hands::kExact, 1.0, {})) return std::nullopt;
  const double exact_sum = problem.sum_of_squares_px2();
  const Eigen::Index residuals = problem.image_residuals();
  Hands hands = Hands::kExact;
  double image_noise_px = std::sqrt(variance(exact_sum, residuals, problem.unknowns()));
  HandNoise hand_noise;

  ProjectionProblem apart(observations, problem.calibration(), distortion_inside);
  if (apart.solve(Hands::kFree, 1.0, {})) {
    const Eigen::Index unknowns = problem.unknowns() - 12 + 6 * problem.positions();
    const double free_sum = apart.sum_of_squares_px2();
    if (contradicts(exact_sum, free_sum, problem.unknowns(), unknowns, residuals)) {
      hands = Hands::kNoisy;
      hand_noise = hand_noise_behind(image_noise_px, problem.calibration());
      image_noise_px =
          std::max(std::sqrt(variance(free_sum, residuals, unknowns)), kExactImages_px);
      if (!solve_with_hand_noise(problem, image_noise_px, hand_noise)) return std::nullopt;
    }
  }

  const double weight_px = std::max(image_noise_px, 1e-12);
  const auto covariance = problem.covariance(hands, weight_px, hand_noise);
  auto errors_px = problem.errors_px();
  if (!covariance || !errors_px) return std::nullopt;
  Refinement refinement{.calibration = problem.calibration(),
                        .sigma = sigma_of(*covariance, distortion_inside),
                        .errors_px = std::move(*errors_px)};
  refinement.calibration.reprojection_px =
      std::sqrt(problem.sum_of_squares_px2() / static_cast<double>(residuals));
  refinement.calibration.image_noise_px = image_noise_px;
  refinement.calibration.hand_noise = hand_noise;
  return refinement;
}

}  // namespace handeye
