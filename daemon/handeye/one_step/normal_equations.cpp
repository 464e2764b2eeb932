// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/normal_equations.hpp"

namespace handeye {

void NormalEquations::linearise(ImageRows& rows) {
  elimination_.eliminate(rows, options_.lens.has_value());
  if (follows()) sight_.linearise(elimination_);
}

bool NormalEquations::estimates(Eigen::Index common) const {
  if (common == kTimeInCommon) return options_.estimate_time_offset;
  return common < kLensInCommon || options_.lens.has_value();
}

bool NormalEquations::factorise(std::span<const HandRow> hands, double image_px, double damping) {
  image_px_ = image_px;
  Eigen::MatrixXd information =
      weight() * (follows() ? sight_.information() : elimination_.information());
  add_hands(hands, information);
  if (follows()) hang_keyframes(damping, information);
  add_priors(information);
  const Eigen::Index common = scene_.common_at();
  for (Eigen::Index i = common; i < scene_.unknowns(); ++i) {
    if (estimates(i - common)) continue;
    information.row(i).head(i).setZero();
    information.col(i).tail(scene_.unknowns() - i - 1).setZero();
    information(i, i) = 1;
  }
  information.diagonal() *= 1.0 + damping;
  factor_.compute(information);
  return factor_.info() == Eigen::Success;
}

void NormalEquations::add_hands(std::span<const HandRow> hands, Eigen::MatrixXd& information) {
  const Eigen::Index common = scene_.common_at();
  hanging_.assign(follows() ? scene_.keyframes() : 0, Hanging{});
  of_hands_.assign(hanging_.size(), Matrix6d::Zero());
  for (const HandRow& row : hands) {
    const MetricFrame& frame = scene_.frames[row.frame];
    const Matrix6d eye = row.by_eye.transpose() * row.by_eye;
    const CommonByEye mixed = row.by_common.transpose() * row.by_eye;
    information.block<kLensInCommon, kLensInCommon>(common, common) +=
        row.by_common.transpose() * row.by_common;
    if (frame.keyframe && follows()) {
      of_hands_[frame.before] += eye;
      hanging_[frame.before].with_common += mixed;
      continue;
    }
    const double b = frame.share;
    const Eigen::Index before = unknowns_of_eye(frame.before);
    const Eigen::Index after = unknowns_of_eye(frame.after);
    information.block<6, 6>(before, before) += (1.0 - b) * (1.0 - b) * eye;
    information.block<kLensInCommon, 6>(common, before) += (1.0 - b) * mixed;
    if (before == after) continue;
    information.block<6, 6>(after, before) += b * (1.0 - b) * eye;
    information.block<6, 6>(after, after) += b * b * eye;
    information.block<kLensInCommon, 6>(common, after) += b * mixed;
  }
}

void NormalEquations::hang_keyframes(double damping, Eigen::MatrixXd& information) {
  const Eigen::Index common = scene_.common_at();
  for (std::size_t k = 0; k < scene_.keyframes(); ++k) {
    Hanging& keyframe = hanging_[k];
    const Eigen::Index at = unknowns_of_eye(k);
    keyframe.sight = weight() * sight_.of_eye(k);
    Matrix6d own = keyframe.sight + of_hands_[k];
    own.diagonal() *= 1.0 + damping;
    keyframe.inverse = own.llt().solve(Matrix6d::Identity());
    const Matrix6d answer = keyframe.inverse * keyframe.sight;
    const CommonByEye& mixed = keyframe.with_common;
    information.block<6, 6>(at, at) -= keyframe.sight * answer;
    information.block<kLensInCommon, 6>(common, at) += mixed * answer;
    information.block<kLensInCommon, kLensInCommon>(common, common) -=
        mixed * keyframe.inverse * mixed.transpose();
  }
}

void NormalEquations::add_priors(Eigen::MatrixXd& information) const {
  const auto add = [&](Eigen::Index i, double sigma) {
    information(scene_.common_at() + i, scene_.common_at() + i) += 1.0 / (sigma * sigma);
  };
  if (options_.estimate_time_offset) add(kTimeInCommon, options_.time_offset_prior_s);
  for (Eigen::Index i = 0; i < kLensParameters && options_.lens; ++i) {
    add(kLensInCommon + i, options_.lens->sigma[i]);
  }
}

MetricColumns NormalEquations::zero(Eigen::Index columns) const {
  return {Eigen::MatrixXd::Zero(scene_.unknowns(), columns),
          Eigen::MatrixXd::Zero(follows() ? scene_.common_at() : 0, columns)};
}

Eigen::MatrixXd NormalEquations::joined(const MetricColumns& columns) const {
  if (!follows()) return columns.of_unknowns;
  Eigen::MatrixXd result(scene_.unknowns(), columns.of_unknowns.cols());
  result << columns.by_sight, columns.of_unknowns.bottomRows<kCommonUnknowns>();
  return result;
}

MetricColumns NormalEquations::solve(const MetricColumns& right) const {
  Eigen::MatrixXd reduced = joined(right);
  auto common = reduced.middleRows<kLensInCommon>(scene_.common_at());
  for (std::size_t k = 0; k < hanging_.size(); ++k) {
    const Eigen::Index at = unknowns_of_eye(k);
    const Eigen::MatrixXd alone = hanging_[k].inverse * right.of_unknowns.middleRows<6>(at);
    reduced.middleRows<6>(at) += hanging_[k].sight * alone;
    common -= hanging_[k].with_common * alone;
  }
  for (Eigen::Index i = 0; i < kCommonUnknowns; ++i) {
    if (!estimates(i)) reduced.row(scene_.common_at() + i).setZero();
  }
  factor_.solveInPlace(reduced);
  if (!follows()) return {reduced, right.by_sight};
  MetricColumns result{right.of_unknowns, reduced.topRows(scene_.common_at())};
  for (std::size_t k = 0; k < scene_.keyframes(); ++k) {
    const Eigen::Index at = unknowns_of_eye(k);
    result.of_unknowns.middleRows<6>(at) =
        hanging_[k].inverse *
        (right.of_unknowns.middleRows<6>(at) + hanging_[k].sight * reduced.middleRows<6>(at) -
         hanging_[k].with_common.transpose() * common);
  }
  result.of_unknowns.bottomRows<kCommonUnknowns>() = reduced.bottomRows<kCommonUnknowns>();
  return result;
}

NormalEquations::Step NormalEquations::step(const ImageGradient& of_images,
                                            MetricColumns gradient) const {
  const Eigen::Index eyes = scene_.common_at();
  const Eigen::VectorXd reduced = elimination_.reduced(of_images);
  double promised = elimination_.promised_by_points(of_images);
  Sight::Pull pull;
  gradient.of_unknowns += weight() * reduced;
  if (follows()) {
    const Eigen::VectorXd taken = of_images.of_unknowns.head(eyes) - reduced.head(eyes);
    pull = sight_.pull(taken);
    gradient.of_unknowns.topRows(eyes) += weight() * taken;
    gradient.of_unknowns.bottomRows<kCommonUnknowns>() +=
        weight() * pull.gradient.tail<kCommonUnknowns>();
    gradient.by_sight += weight() * pull.gradient.head(eyes);
    promised += pull.cost;
  }
  for (Eigen::Index i = 0; i < kCommonUnknowns; ++i) {
    if (!estimates(i)) gradient.of_unknowns.row(eyes + i).setZero();
  }
  const MetricColumns answer = solve(gradient);
  Step step;
  step.of_unknowns = -answer.of_unknowns;
  step.promised = weight() * promised +
                  0.5 * gradient.of_unknowns.cwiseProduct(answer.of_unknowns).sum() +
                  0.5 * gradient.by_sight.cwiseProduct(answer.by_sight).sum();
  Eigen::VectorXd for_points = step.of_unknowns;
  if (follows()) {
    for_points.head(eyes) = pull.for_points - sight_.keyframes_for_points(joined(answer));
  }
  step.of_points = elimination_.point_steps(of_images, for_points);
  return step;
}

std::vector<CommonVector> NormalEquations::pulls_of_points(const MetricColumns& by_common) const {
  Eigen::MatrixXd for_points = by_common.of_unknowns;
  if (follows()) {
    for_points.topRows(scene_.common_at()) = sight_.keyframes_for_points(joined(by_common));
  }
  return elimination_.pulls_of_points(weight() * by_common.of_unknowns, weight() * for_points);
}

}  // namespace handeye
