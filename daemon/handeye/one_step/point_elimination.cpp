// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/point_elimination.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace handeye {
namespace {

/// So little, against the point's best-known direction, that no direction is without a step.
constexpr double kLeastInformation = 1e-10;

/// W^T step: what a keyframe's step does to the gradient of the point.
Eigen::Vector3d point_pull(const ImageRow& row, const Vector6d& eye_step) {
  const Eigen::Vector3d moved =
      row.point_from_eye_mm.cross(eye_step.head<3>()) - eye_step.tail<3>();
  return row.by_point.transpose() * (row.by_point * moved);
}

}  // namespace

void PointElimination::eliminate(ImageRows& rows, bool lens_free) {
  std::swap(rows_, rows.rows);
  lens_free_ = lens_free;
  const std::size_t n = scene_.keyframes();
  blocks_.assign(n * (n + 1) / 2, Matrix6d::Zero());
  of_eyes_.assign(n, Matrix6d::Zero());
  lens_by_eye_.assign(n, Matrix6d::Zero());
  lens_.setZero();
  inverse_roots_.resize(scene_.points());
  for (std::size_t j = 0; j < scene_.points(); ++j) add_point(j);
  for (std::size_t k = 0; k < n; ++k) blocks_[block(k, k)] += of_eyes_[k];
  write_information();
}

void PointElimination::add_point(std::size_t j) {
  const std::size_t begin = scene_.first_of_point[j];
  const std::size_t end = scene_.first_of_point[j + 1];
  Eigen::Matrix3d point = Eigen::Matrix3d::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    point.noalias() += rows_[i].by_point.transpose() * rows_[i].by_point;
  }
  point.diagonal().array() += kLeastInformation * point.trace();
  const Eigen::Matrix3d inverse_root = point.llt().matrixL().solve(Eigen::Matrix3d::Identity());
  inverse_roots_[j] = inverse_root;

  eliminated_.resize(end - begin);
  Matrix63 lens_eliminated = Matrix63::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    const ImageRow& row = rows_[i];
    const std::size_t k = scene_.observations[i].keyframe;
    const Matrix26 eye = pixel_by_eye(row);
    const Eigen::Matrix<double, 2, 3> whitened = row.by_point * inverse_root.transpose();
    eliminated_[i - begin].noalias() = eye.transpose() * whitened;
    of_eyes_[k].noalias() += eye.transpose() * eye;
    if (!lens_free_) continue;
    lens_eliminated.noalias() += row.by_lens.transpose() * whitened;
    lens_by_eye_[k].noalias() += row.by_lens.transpose() * eye;
    lens_.noalias() += row.by_lens.transpose() * row.by_lens;
  }
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t k = scene_.observations[i].keyframe;
    Matrix6d* const row_of_blocks = &blocks_[block(k, 0)];
    const Matrix63& own = eliminated_[i - begin];
    for (std::size_t other = begin; other <= i; ++other) {
      row_of_blocks[scene_.observations[other].keyframe].noalias() -=
          own.lazyProduct(eliminated_[other - begin].transpose());
    }
    if (lens_free_) lens_by_eye_[k].noalias() -= lens_eliminated * own.transpose();
  }
  if (lens_free_) lens_.noalias() -= lens_eliminated * lens_eliminated.transpose();
}

void PointElimination::write_information() {
  information_.setZero(scene_.unknowns(), scene_.unknowns());
  const Eigen::Index lens_at = scene_.common_at() + kLensInCommon;
  for (std::size_t k = 0; k < scene_.keyframes(); ++k) {
    for (std::size_t other = 0; other <= k; ++other) {
      information_.block<6, 6>(unknowns_of_eye(k), unknowns_of_eye(other)) =
          blocks_[block(k, other)];
    }
    information_.block<6, 6>(lens_at, unknowns_of_eye(k)) = lens_by_eye_[k];
  }
  information_.block<6, 6>(lens_at, lens_at) = lens_;
}

Eigen::VectorXd PointElimination::reduced(const ImageGradient& gradient) const {
  Eigen::VectorXd result = gradient.of_unknowns;
  LensVector of_lens = LensVector::Zero();
  for (std::size_t j = 0; j < scene_.points(); ++j) {
    const Eigen::Vector3d step =
        inverse_roots_[j].transpose() * (inverse_roots_[j] * gradient.of_points[j]);
    for (std::size_t i = scene_.first_of_point[j]; i < scene_.first_of_point[j + 1]; ++i) {
      const ImageRow& row = rows_[i];
      const Eigen::Vector2d moved = row.by_point * step;
      const Eigen::Vector3d pull = row.by_point.transpose() * moved;
      const Eigen::Index at = unknowns_of_eye(scene_.observations[i].keyframe);
      result.segment<3>(at) += row.point_from_eye_mm.cross(pull);
      result.segment<3>(at + 3) += pull;
      if (lens_free_) of_lens.noalias() += row.by_lens.transpose() * moved;
    }
  }
  result.tail<kLensParameters>() -= of_lens;
  return result;
}

double PointElimination::promised_by_points(const ImageGradient& gradient) const {
  double promised = 0;
  for (std::size_t j = 0; j < scene_.points(); ++j) {
    promised += 0.5 * (inverse_roots_[j] * gradient.of_points[j]).squaredNorm();
  }
  return promised;
}

std::vector<Eigen::Vector3d> PointElimination::point_steps(const ImageGradient& gradient,
                                                           const Eigen::VectorXd& step) const {
  std::vector<Eigen::Vector3d> steps(scene_.points());
  const LensVector lens_step = step.tail<kLensParameters>();
  for (std::size_t j = 0; j < scene_.points(); ++j) {
    Eigen::Vector3d pull = gradient.of_points[j];
    for (std::size_t i = scene_.first_of_point[j]; i < scene_.first_of_point[j + 1]; ++i) {
      const ImageRow& row = rows_[i];
      pull += point_pull(row, step.segment<6>(unknowns_of_eye(scene_.observations[i].keyframe)));
      if (lens_free_) pull += row.by_point.transpose() * (row.by_lens * lens_step);
    }
    steps[j] = -inverse_roots_[j].transpose() * (inverse_roots_[j] * pull);
  }
  return steps;
}

std::vector<CommonVector> PointElimination::pulls_of_points(
    const Eigen::MatrixXd& by_gradient, const Eigen::MatrixXd& for_points) const {
  using CommonBy2 = Eigen::Matrix<double, kCommonUnknowns, 2>;
  using CommonBy3 = Eigen::Matrix<double, kCommonUnknowns, 3>;
  const auto by_error = [&](const Eigen::MatrixXd& answers, const ImageRow& row, std::size_t k) {
    CommonBy2 result =
        answers.middleRows<6>(unknowns_of_eye(k)).transpose() * pixel_by_eye(row).transpose();
    if (lens_free_) {
      result += answers.bottomRows<kLensParameters>().transpose() * row.by_lens.transpose();
    }
    return result;
  };
  std::vector<CommonVector> pulls;
  pulls.reserve(scene_.points());
  for (std::size_t j = 0; j < scene_.points(); ++j) {
    CommonVector pull = CommonVector::Zero();
    CommonBy3 by_point = CommonBy3::Zero();
    Eigen::Vector3d of_point = Eigen::Vector3d::Zero();
    for (std::size_t i = scene_.first_of_point[j]; i < scene_.first_of_point[j + 1]; ++i) {
      const ImageRow& row = rows_[i];
      const std::size_t k = scene_.observations[i].keyframe;
      pull += by_error(by_gradient, row, k) * row.error;
      by_point += by_error(for_points, row, k) * row.by_point;
      of_point += row.by_point.transpose() * row.error;
    }
    pull -= by_point * (inverse_roots_[j].transpose() * (inverse_roots_[j] * of_point));
    pulls.push_back(pull);
  }
  return pulls;
}

}  // namespace handeye
