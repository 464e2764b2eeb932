// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/matrix_method.hpp"

#include <algorithm>

#include <Eigen/Dense>

#include "daemon/handeye/perspective/gibbs.hpp"

namespace handeye {
namespace {

constexpr double kSingular = 1e-12;  // of the column-scaled equations: beyond it, not determined
constexpr double kConverged = 1e-8;
constexpr int kMaxIterations = 50;

/// Least squares with the columns scaled alike; nothing where a direction is not determined.
std::optional<Eigen::VectorXd> solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd scale = a.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a * scale.asDiagonal());
  qr.setThreshold(kSingular);
  if (!a.allFinite() || qr.rank() < a.cols()) return std::nullopt;
  const Eigen::VectorXd x = scale.asDiagonal() * qr.solve(b);
  if (!x.allFinite()) return std::nullopt;
  return x;
}

/// R_Y from Q_i R_Y = R_Y R_A^T with Q_i = N_1^-1 N_i: linear in the elements of R_Y.
std::optional<Eigen::Matrix3d> linear_rotation(std::span<const MatrixPosition> positions) {
  const Eigen::Matrix3d n1_inverse = positions.front().matrix.leftCols<3>().inverse();
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const MatrixPosition& position : positions.subspan(1)) {
    const Eigen::Matrix3d q = nearest_rotation(n1_inverse * position.matrix.leftCols<3>());
    const Eigen::Matrix3d a = position.hand1_from_hand.linear();
    Eigen::Matrix<double, 9, 9> equation = Eigen::Matrix<double, 9, 9>::Zero();
    for (Eigen::Index row = 0; row < 3; ++row) {
      equation.block<3, 3>(3 * row, 3 * row) += q;  // columns of R_Y one below the other
      for (Eigen::Index column = 0; column < 3; ++column) {
        equation.block<3, 3>(3 * row, 3 * column).diagonal().array() -= a(row, column);
      }
    }
    normal += equation.transpose() * equation;
  }
  if (!normal.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(normal);
  // Parallel axes leave a second direction free.
  if (!(eigen.eigenvalues()(1) > kSingular * eigen.eigenvalues()(8))) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> r = eigen.eigenvectors().col(0);
  Eigen::Matrix3d rotation;
  rotation << r.head<3>(), r.segment<3>(3), r.tail<3>();
  return nearest_rotation(rotation.determinant() < 0.0 ? Eigen::Matrix3d(-rotation) : rotation);
}

}  // namespace

std::optional<Pose> closed_form_object_from_hand(std::span<const MatrixPosition> positions) {
  if (positions.size() < 3) return std::nullopt;
  const auto rotation = linear_rotation(positions);
  if (!rotation) return std::nullopt;
  const auto rows = 3 * static_cast<Eigen::Index>(positions.size() - 1);
  Eigen::MatrixXd a(rows, 3);
  Eigen::VectorXd b(rows);
  const PerspectiveMatrix& first = positions.front().matrix;
  for (Eigen::Index i = 0; 3 * i < rows; ++i) {
    const MatrixPosition& position = positions[static_cast<std::size_t>(i) + 1];
    const Eigen::Matrix3d n = position.matrix.leftCols<3>();
    a.middleRows<3>(3 * i) = n - first.leftCols<3>();
    b.segment<3>(3 * i) = first.col(3) - position.matrix.col(3) -
                          n * *rotation * position.hand1_from_hand.translation();
  }
  const auto translation = solve(a, b);
  if (!translation) return std::nullopt;
  Pose object_from_hand = Pose::Identity();
  object_from_hand.linear() = *rotation;
  object_from_hand.translation() = *translation;
  return object_from_hand;
}

std::optional<Pose> gauss_newton_step(std::span<const MatrixPosition> positions,
                                      const Pose& object_from_hand) {
  if (positions.size() < 3) return std::nullopt;
  BasedGibbs gibbs{Eigen::Quaterniond(object_from_hand.linear())};
  const Eigen::Matrix3d w_by_z = gibbs.rotation_vector_by_z();
  const Eigen::Matrix3d r = object_from_hand.linear();
  const Eigen::Vector3d p = object_from_hand.translation();
  const Eigen::Matrix3d n1 = positions.front().matrix.leftCols<3>();
  const auto rows = 12 * static_cast<Eigen::Index>(positions.size() - 1);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, 6);
  Eigen::VectorXd residual(rows);
  for (Eigen::Index i = 0; 12 * i < rows; ++i) {
    const MatrixPosition& position = positions[static_cast<std::size_t>(i) + 1];
    const Eigen::Matrix3d n = position.matrix.leftCols<3>();
    const Eigen::Matrix3d& a = position.hand1_from_hand.linear();
    for (Eigen::Index column = 0; column < 3; ++column) {
      const Eigen::Vector3d ra = r * a.col(column);
      const Eigen::Index row = 12 * i + 3 * column;
      residual.segment<3>(row) = n * ra - n1 * r.col(column);
      jacobian.block<3, 3>(row, 0) = (n1 * skew(r.col(column)) - n * skew(ra)) * w_by_z;
    }
    const Eigen::Vector3d rt = r * position.hand1_from_hand.translation();
    const Eigen::Index row = 12 * i + 9;
    residual.segment<3>(row) =
        n * (rt + p) + position.matrix.col(3) - n1 * p - positions.front().matrix.col(3);
    jacobian.block<3, 3>(row, 0) = -n * skew(rt) * w_by_z;
    jacobian.block<3, 3>(row, 3) = n - n1;
  }
  const auto step = solve(jacobian, -residual);
  if (!step) return std::nullopt;
  gibbs.z += step->head<3>();
  return make_pose(gibbs.rotation(), p + step->tail<3>());
}

double step_size(const Pose& from, const Pose& to) {
  const double change = (to.translation() - from.translation()).norm();
  const double length = std::max(to.translation().norm(), 1.0);
  return std::max(rotation_angle_rad(from.linear(), to.linear()), change / length);
}

std::optional<MatrixMethodResult> matrix_method(std::span<const MatrixPosition> positions,
                                                const Pose& start) {
  MatrixMethodResult result{.object_from_hand = start};
  while (result.iterations < kMaxIterations) {
    const auto next = gauss_newton_step(positions, result.object_from_hand);
    if (!next) return std::nullopt;
    const double size = step_size(result.object_from_hand, *next);
    result.object_from_hand = *next;
    ++result.iterations;
    if (size < kConverged) return result;
  }
  return std::nullopt;
}

}  // namespace handeye
