// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/linear_parts.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/movements.hpp"

namespace handeye {
namespace {

constexpr double kMinConditioning = 1e-9;  // smallest to largest singular value, columns scaled
constexpr int kMaxSignRounds = 10;

struct QuaternionPair {
  Eigen::Quaterniond hand;
  Eigen::Quaterniond eye;
};

/// Of R_E R_X - R_X R_H = 0 the nearest rotation to the null vector. By normal equations: it only
/// settles signs.
Eigen::Quaterniond rotation_by_entries(std::span<const Movement> movements) {
  using Matrix9d = Eigen::Matrix<double, 9, 9>;
  Matrix9d normal = Matrix9d::Zero();
  for (const Movement& movement : movements) {
    const Matrix9d rows = entry_rows(movement);
    normal.noalias() += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix9d> eigen(normal);
  const Eigen::Matrix<double, 9, 1> smallest = eigen.eigenvectors().col(0);
  Eigen::Matrix3d matrix = smallest.reshaped<Eigen::RowMajor>(3, 3);
  if (matrix.determinant() < 0) matrix = -matrix;
  return Eigen::Quaterniond(nearest_rotation(matrix));
}

/// Lets every eye's quaternion agree with q_H turned by `about`. Returns whether any had not.
bool agree(std::vector<QuaternionPair>& pairs, const Eigen::Quaterniond& about) {
  bool changed = false;
  for (auto& [hand, eye] : pairs) {
    if (eye.dot(about * hand * about.conjugate()) >= 0) continue;
    eye.coeffs() = -eye.coeffs();
    changed = true;
  }
  return changed;
}

struct QuaternionFit {
  Eigen::Quaterniond rotation{Eigen::Quaterniond::Identity()};
  double residual{0};
};

/// q of sum |q_E q - q q_H|^2, signs as they are. Nothing when two or more q will do, as they do
/// for fewer than two pairs.
std::optional<QuaternionFit> fit(const std::vector<QuaternionPair>& pairs) {
  if (pairs.size() < 2) return std::nullopt;
  Eigen::MatrixXd stacked(4 * static_cast<Eigen::Index>(pairs.size()), 4);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    stacked.middleRows<4>(4 * static_cast<Eigen::Index>(k)) =
        left_product(pairs[k].eye) - right_product(pairs[k].hand);
  }
  const auto [vectors, values] = right_singular(stacked);
  if (!(values[2] > kMinConditioning * values[0])) return std::nullopt;
  const Eigen::Vector4d q = vectors.col(3);
  return QuaternionFit{Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized(), values[3]};
}

/// Solves and lets the signs agree in turn, until they do.
std::optional<QuaternionFit> fit_and_agree(std::vector<QuaternionPair> pairs) {
  std::optional<QuaternionFit> best = fit(pairs);
  for (int round = 0; best && round < kMaxSignRounds && agree(pairs, best->rotation); ++round) {
    best = fit(pairs);
  }
  return best;
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

Eigen::Matrix<double, 9, 9> entry_rows(const Movement& movement) {
  const auto& [hand, eye] = movement;
  Eigen::Matrix<double, 9, 9> rows = Eigen::Matrix<double, 9, 9>::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      rows.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(eye.linear()(i, j));
    }
    rows.block<3, 3>(3 * i, 3 * i) -= hand.linear().transpose();
  }
  return rows;
}

RightSingular right_singular(const Eigen::MatrixXd& tall) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(tall);
  const Eigen::Index n = std::min(tall.rows(), tall.cols());
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(triangle, Eigen::ComputeFullV);
  return {svd.matrixV(), svd.singularValues()};
}

std::optional<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& matrix,
                                             const Eigen::VectorXd& right) {
  if (matrix.rows() < matrix.cols()) return std::nullopt;
  const Eigen::VectorXd column_norms = matrix.colwise().norm();
  if (!(column_norms.minCoeff() > 0)) return std::nullopt;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix * column_norms.cwiseInverse().asDiagonal());
  const Eigen::Index n = matrix.cols();
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(triangle).singularValues();
  if (!(singular[n - 1] > kMinConditioning * singular[0])) return std::nullopt;
  Eigen::VectorXd solution = qr.solve(right).cwiseQuotient(column_norms);
  if (!solution.allFinite()) return std::nullopt;
  return solution;
}

std::optional<Eigen::Matrix3d> eye_from_hand_rotation(std::span<const Movement> movements) {
  std::vector<QuaternionPair> pairs;
  pairs.reserve(movements.size());
  for (const auto& [hand, eye] : movements) {
    pairs.push_back({Eigen::Quaterniond(hand.linear()), Eigen::Quaterniond(eye.linear())});
  }
  // Two starts: the nine entries know no signs but are weak where all axes lie in a plane and all
  // angles are near 180 degrees; angles below 180 degrees are right wherever noise does not cross
  // it.
  std::vector<QuaternionPair> below_half_turn = pairs;
  for (auto& [hand, eye] : below_half_turn) {
    if (hand.w() * eye.w() < 0) eye.coeffs() = -eye.coeffs();
  }
  agree(pairs, rotation_by_entries(movements));
  const auto by_entries = fit_and_agree(std::move(pairs));
  const auto by_angles = fit_and_agree(std::move(below_half_turn));
  const auto& better = !by_entries || (by_angles && by_angles->residual < by_entries->residual)
                           ? by_angles
                           : by_entries;
  if (!better) return std::nullopt;
  return better->rotation.toRotationMatrix();
}

std::optional<Eigen::Matrix3d> rotation_between(std::span<const VectorPair> pairs) {
  std::vector<QuaternionPair> pure;
  pure.reserve(pairs.size());
  for (const auto& [hand, eye] : pairs) {
    pure.push_back({Eigen::Quaterniond(0, hand.x(), hand.y(), hand.z()),
                    Eigen::Quaterniond(0, eye.x(), eye.y(), eye.z())});
  }
  const auto found = fit(pure);
  if (!found) return std::nullopt;
  return found->rotation.toRotationMatrix();
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
  const auto solution = least_squares(matrix, right);
  if (!solution || !((*solution)[3] > 0)) return std::nullopt;
  return ScaleAndTranslation{solution->head<3>(), (*solution)[3]};
}

std::optional<Eigen::Vector3d> translation_of(std::span<const Movement> movements,
                                              const Eigen::Matrix3d& eye_from_hand) {
  const auto n = static_cast<Eigen::Index>(movements.size());
  Eigen::MatrixXd matrix(3 * n, 3);
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& [hand, eye] = movements[static_cast<std::size_t>(k)];
    matrix.middleRows<3>(3 * k) = Eigen::Matrix3d::Identity() - eye.linear();
    right.segment<3>(3 * k) = eye.translation() - eye_from_hand * hand.translation();
  }
  const auto solution = least_squares(matrix, right);
  if (!solution) return std::nullopt;
  return Eigen::Vector3d(*solution);
}

std::optional<HandEyeSolution> rotation_then_translation(const HandEyeProblem& problem,
                                                         RotationSolver rotation_solver) {
  const auto normalised = normalise(problem.movements, ScaleMode::kKnown);
  if (!normalised) return std::nullopt;
  const auto rotation = rotation_solver(normalised->movements);
  if (!rotation) return std::nullopt;
  const auto translation = translation_of(normalised->movements, *rotation);
  if (!translation) return std::nullopt;
  Pose eye_from_hand = Pose::Identity();
  eye_from_hand.linear() = *rotation;
  eye_from_hand.translation() = *translation;
  return normalised->restore(eye_from_hand, 1.0);
}

}  // namespace handeye
