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

Vector6d HandRow::change(const MetricScene& scene, const MetricColumns& steps,
                         Eigen::Index column) const {
  const MetricFrame& of = scene.frames[frame];
  const auto common = steps.of_unknowns.col(column).segment<kLensInCommon>(scene.common_at());
  const Eigen::Index before = unknowns_of_eye(of.before);
  if (of.keyframe) {
    return by_eye * steps.of_unknowns.col(column).segment<6>(before) + by_common * common;
  }
  const auto sighted = steps.by_sight.col(column);
  return by_eye * ((1.0 - of.share) * sighted.segment<6>(before) +
                   of.share * sighted.segment<6>(unknowns_of_eye(of.after))) +
         by_common * common;
}

void HandRow::add_gradient(const MetricScene& scene, const Vector6d& value, MetricColumns& sum,
                           Eigen::Index column) const {
  const MetricFrame& of = scene.frames[frame];
  const Vector6d eye = by_eye.transpose() * value;
  auto unknowns = sum.of_unknowns.col(column);
  unknowns.segment<kLensInCommon>(scene.common_at()) += by_common.transpose() * value;
  if (of.keyframe) {
    unknowns.segment<6>(unknowns_of_eye(of.before)) += eye;
    return;
  }
  auto sighted = sum.by_sight.col(column);
  sighted.segment<6>(unknowns_of_eye(of.before)) += (1.0 - of.share) * eye;
  sighted.segment<6>(unknowns_of_eye(of.after)) += of.share * eye;
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
