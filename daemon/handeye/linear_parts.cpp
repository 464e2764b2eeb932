// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/linear_parts.hpp"

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr double kMinConditioning = 1e-9;  // smallest to largest singular value, columns scaled

/// vec(R_X) of R_E R_X - R_X R_H = 0, rows of R_X one after the other.
Eigen::Matrix3d rotation_by_entries(std::span<const Movement> movements) {
  using Matrix9d = Eigen::Matrix<double, 9, 9>;
  Matrix9d normal = Matrix9d::Zero();
  for (const auto& [hand, eye] : movements) {
    const Eigen::Matrix3d hand_transposed = hand.linear().transpose();
    Matrix9d rows = Matrix9d::Zero();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        rows.block<3, 3>(3 * i, 3 * j).diagonal().array() += eye.linear()(i, j);
      }
      rows.block<3, 3>(3 * i, 3 * i) -= hand_transposed;
    }
    normal += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix9d> eigen(normal);
  const Eigen::Matrix<double, 9, 1> smallest = eigen.eigenvectors().col(0);
  Eigen::Matrix3d matrix = smallest.reshaped<Eigen::RowMajor>(3, 3);
  if (matrix.determinant() < 0) matrix = -matrix;
  return nearest_rotation(matrix);
}

}  // namespace

Eigen::Matrix4d left_product(const Eigen::Quaterniond& q) {
  Eigen::Matrix4d matrix;
  matrix << q.w(), -q.vec().transpose(), q.vec(),
      q.w() * Eigen::Matrix3d::Identity() + skew(q.vec());
  return matrix;
}

Eigen::Matrix4d right_product(const Eigen::Quaterniond& q) {
  Eigen::Matrix4d matrix;
  matrix << q.w(), -q.vec().transpose(), q.vec(),
      q.w() * Eigen::Matrix3d::Identity() - skew(q.vec());
  return matrix;
}

RightSingular right_singular(const Eigen::MatrixXd& tall) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(tall);
  const Eigen::Index n = std::min(tall.rows(), tall.cols());
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(triangle, Eigen::ComputeFullV);
  return {svd.matrixV(), svd.singularValues()};
}

std::optional<Eigen::Matrix3d> eye_from_hand_rotation(std::span<const Movement> movements) {
  const Eigen::Quaterniond start(rotation_by_entries(movements));
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  for (const auto& [hand, eye] : movements) {
    const Eigen::Quaterniond q_hand(hand.linear());
    Eigen::Quaterniond q_eye(eye.linear());
    if (q_eye.dot(start * q_hand * start.conjugate()) < 0) q_eye.coeffs() = -q_eye.coeffs();
    const Eigen::Matrix4d rows = left_product(q_eye) - right_product(q_hand);
    normal += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(normal);
  if (eigen.info() != Eigen::Success) return std::nullopt;
  const Eigen::Vector4d q = eigen.eigenvectors().col(0);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

std::optional<ScaleAndTranslation> scale_and_translation(std::span<const Movement> movements,
                                                         const Eigen::Matrix3d& eye_from_hand) {
  const auto n = static_cast<Eigen::Index>(movements.size());
  Eigen::MatrixXd matrix(3 * n, 4);
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& [hand, eye] = movements[static_cast<std::size_t>(k)];
    matrix.block<3, 3>(3 * k, 0) = Eigen::Matrix3d::Identity() - eye.linear();
    matrix.block<3, 1>(3 * k, 3) = eye_from_hand * hand.translation();
    right.segment<3>(3 * k) = eye.translation();
  }
  const Eigen::Vector4d column_norms = matrix.colwise().norm();
  if (!(column_norms.minCoeff() > 0)) return std::nullopt;
  const Eigen::MatrixXd scaled = matrix * column_norms.cwiseInverse().asDiagonal();
  const Eigen::VectorXd singular = right_singular(scaled).values;
  if (!(singular[3] > kMinConditioning * singular[0])) return std::nullopt;
  const Eigen::Vector4d solution = scaled.householderQr().solve(right).cwiseQuotient(column_norms);
  if (!solution.allFinite() || !(solution[3] > 0)) return std::nullopt;
  return ScaleAndTranslation{solution.head<3>(), solution[3]};
}

}  // namespace handeye
