// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/path_scale.hpp"

#include <algorithm>
#include <limits>

namespace handeye {
namespace {

/// The derivative of log(spread) by the centres of a part's keyframes.
Eigen::VectorXd by_centres(const MetricProblem& problem,
                           const std::vector<std::size_t>& keyframes) {
  const std::vector<Pose>& eyes = problem.state().room_from_eye;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::size_t k : keyframes) {
    mean += eyes[k].translation() / static_cast<double>(keyframes.size());
  }
  Eigen::VectorXd result = Eigen::VectorXd::Zero(problem.scene().unknowns());
  double squares = 0;
  for (const std::size_t k : keyframes) {
    const Eigen::Vector3d from_mean = eyes[k].translation() - mean;
    result.segment<3>(unknowns_of_eye(k) + 3) = from_mean;
    squares += from_mean.squaredNorm();
  }
  return result / squares;
}

}  // namespace

double log_scale_variance(const MetricProblem& problem) {
  const std::vector<std::vector<std::size_t>>& parts = problem.scene().keyframes_of_parts;
  MetricColumns right = problem.equations().zero(static_cast<Eigen::Index>(parts.size()));
  for (std::size_t part = 0; part < parts.size(); ++part) {
    right.of_unknowns.col(static_cast<Eigen::Index>(part)) = by_centres(problem, parts[part]);
  }
  const MetricColumns answers = problem.equations().solve(right);
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index part = 0; part < right.of_unknowns.cols(); ++part) {
    const double variance = right.of_unknowns.col(part).dot(answers.of_unknowns.col(part));
    if (variance >= 0) least = std::min(least, variance);
  }
  return least;
}

}  // namespace handeye
