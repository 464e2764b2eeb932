// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/hand_equations.hpp"

#include <cmath>

#include "daemon/handeye/one_step/hand_term.hpp"

namespace handeye {
namespace {

Vector6d whitened(const MetricFrame& frame, const Matrix6d& whitening, const Pose& eye,
                  const MetricState& state) {
  return whitening * hand_residual(*frame.hand, eye, state);
}

}  // namespace

Vector6d HandRow::change(const MetricScene& scene, const Eigen::MatrixXd& steps,
                         Eigen::Index column) const {
  const MetricFrame& of = scene.frames[frame];
  const auto step = steps.col(column);
  const Vector6d eye = (1.0 - of.share) * step.segment<6>(unknowns_of_eye(of.before)) +
                       of.share * step.segment<6>(unknowns_of_eye(of.after));
  return by_eye * eye + by_common * step.segment<kLensInCommon>(scene.common_at());
}

void HandRow::add_gradient(const MetricScene& scene, const Vector6d& value,
                           Eigen::VectorXd& sum) const {
  const MetricFrame& of = scene.frames[frame];
  const Vector6d eye = by_eye.transpose() * value;
  sum.segment<6>(unknowns_of_eye(of.before)) += (1.0 - of.share) * eye;
  sum.segment<6>(unknowns_of_eye(of.after)) += of.share * eye;
  sum.segment<kLensInCommon>(scene.common_at()) += by_common.transpose() * value;
}

void HandRow::add_information(const MetricScene& scene, Eigen::MatrixXd& information) const {
  const MetricFrame& of = scene.frames[frame];
  const Eigen::Index before = unknowns_of_eye(of.before);
  const Eigen::Index after = unknowns_of_eye(of.after);
  const Eigen::Index common = scene.common_at();
  const Matrix6d eye = by_eye.transpose() * by_eye;
  const Eigen::Matrix<double, kLensInCommon, 6> mixed = by_common.transpose() * by_eye;
  information.block<kLensInCommon, kLensInCommon>(common, common) +=
      by_common.transpose() * by_common;
  if (before == after) {
    information.block<6, 6>(before, before) += eye;
    information.block<kLensInCommon, 6>(common, before) += mixed;
    return;
  }
  const double share = of.share;
  information.block<6, 6>(before, before) += (1.0 - share) * (1.0 - share) * eye;
  information.block<6, 6>(after, before) += share * (1.0 - share) * eye;
  information.block<6, 6>(after, after) += share * share * eye;
  information.block<kLensInCommon, 6>(common, before) += (1.0 - share) * mixed;
  information.block<kLensInCommon, 6>(common, after) += share * mixed;
}

std::vector<HandRow> hand_rows(const MetricScene& scene, const MetricState& state,
                               const std::vector<Pose>& eyes, const HandSelection& hands) {
  std::vector<HandRow> rows;
  rows.reserve(scene.frames.size());
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    if (!hands.kept[k]) continue;
    const Matrix6d& whitening = hands.weights.whitenings[k];
    const HandDerivatives by = hand_derivatives(*scene.frames[k].hand, eyes[k], state);
    HandRow& row = rows.emplace_back();
    row.frame = k;
    row.residual = whitened(scene.frames[k], whitening, eyes[k], state);
    const double norm = row.residual.norm();
    row.weight = norm > hands.huber ? hands.huber / norm : 1.0;
    const double root = std::sqrt(row.weight);
    row.residual *= root;
    row.by_eye = root * whitening * by.by_eye;
    row.by_common.leftCols<6>() = root * whitening * by.by_hand_from_eye;
    row.by_common.col(kTimeInCommon) = root * whitening * by.by_time;
  }
  return rows;
}

double hand_cost(const MetricScene& scene, const MetricState& state, const std::vector<Pose>& eyes,
                 const HandSelection& hands) {
  double cost = 0;
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    if (!hands.kept[k]) continue;
    const double norm =
        whitened(scene.frames[k], hands.weights.whitenings[k], eyes[k], state).norm();
    cost += norm > hands.huber ? hands.huber * (norm - 0.5 * hands.huber) : 0.5 * norm * norm;
  }
  return cost;
}

}  // namespace handeye
