// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/gauss_newton.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr double kConverged = 1e-8;
constexpr int kMaxIterations = 50;
constexpr double kSingular = 1e-12;

constexpr Eigen::Index kOfMatrix = 12;                      // M, row by row
constexpr Eigen::Index kOfLens = 3;                         // k1, centre
constexpr Eigen::Index kColumns = kOfMatrix + kOfLens + 1;  // and the right-hand side

using Row = Eigen::Matrix<double, 1, kColumns>;

/// [J_M J_lens -e] of the two image equations of a point.
Eigen::Matrix<double, 2, kColumns> image_equations(const ObjectPoint& point, const SensorLens& lens,
                                                   const PerspectiveMatrix& matrix) {
  const Eigen::Vector2d x = sensor_mm(lens, point.pixel);
  const double r2 = x.squaredNorm();
  const Eigen::RowVector4d object = point.object_mm.homogeneous().transpose();
  const Eigen::Vector3d h = matrix * object.transpose();
  const Eigen::Vector2d image = h.hnormalized();
  Eigen::Matrix<double, 2, kColumns> equations;
  equations.setZero();
  equations.block<1, 4>(0, 0) = -object / h.z();
  equations.block<1, 4>(1, 4) = -object / h.z();
  equations.middleCols<4>(8) = image * object / h.z();
  equations.col(kOfMatrix) = x * r2;
  equations.middleCols<2>(kOfMatrix + 1) =
      -((1.0 + lens.k1_per_mm2 * r2) * Eigen::Matrix2d::Identity() +
        2.0 * lens.k1_per_mm2 * x * x.transpose()) *
      lens.pixel_mm.asDiagonal();
  equations.rightCols<1>() = image - undistorted_mm(lens, point.pixel);
  return equations;
}

/// Row a of the 3x3 part against row b: their product shall be `wanted`.
Row product_equation(const PerspectiveMatrix& matrix, Eigen::Index a, Eigen::Index b,
                     double wanted) {
  Row equation = Row::Zero();
  equation.segment<3>(4 * a) += matrix.row(b).head<3>();
  equation.segment<3>(4 * b) += matrix.row(a).head<3>();
  equation(kColumns - 1) = wanted - matrix.row(a).head<3>().dot(matrix.row(b).head<3>());
  return equation;
}

/// One position's equations by orthogonal transformation, upper triangular: the first 12 rows give
/// its matrix once the lens is known, the next 3 are what it says about the lens.
std::optional<Eigen::Matrix<double, kColumns, kColumns>> triangular_equations(
    const ObservedPosition& position, const SensorLens& lens, const PerspectiveMatrix& matrix) {
  const auto points = static_cast<Eigen::Index>(position.points.size());
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(std::max(2 * points + 3, kColumns), kColumns);
  for (Eigen::Index i = 0; i < points; ++i) {
    equations.middleRows<2>(2 * i) =
        image_equations(position.points[static_cast<std::size_t>(i)], lens, matrix);
  }
  equations.row(2 * points) = product_equation(matrix, 2, 2, 1.0);
  equations.row(2 * points + 1) = product_equation(matrix, 0, 2, 0.0);
  equations.row(2 * points + 2) = product_equation(matrix, 1, 2, 0.0);
  if (!equations.allFinite()) return std::nullopt;
  const Eigen::VectorXd norms = equations.colwise().norm();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(equations);
  Eigen::Matrix<double, kColumns, kColumns> triangular =
      qr.matrixQR().topRows(kColumns).triangularView<Eigen::Upper>();
  for (Eigen::Index i = 0; i < kOfMatrix; ++i) {
    if (!(std::abs(triangular(i, i)) > kSingular * norms(i))) return std::nullopt;
  }
  return triangular;
}

/// Step of k1 and the centre from what all positions say about them.
std::optional<Eigen::Vector3d> lens_step(
    std::span<const Eigen::Matrix<double, kColumns, kColumns>> positions) {
  Eigen::MatrixXd stacked(kOfLens * static_cast<Eigen::Index>(positions.size()), kOfLens + 1);
  Eigen::Index row = 0;
  for (const auto& position : positions) {
    stacked.middleRows<kOfLens>(row) = position.block<kOfLens, kOfLens + 1>(kOfMatrix, kOfMatrix);
    row += kOfLens;
  }
  const Eigen::Vector3d scale =
      stacked.leftCols<kOfLens>().colwise().norm().cwiseMax(1e-300).cwiseInverse();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(stacked.leftCols<kOfLens>() * scale.asDiagonal());
  qr.setThreshold(kSingular);
  if (qr.rank() < kOfLens) return std::nullopt;
  const Eigen::Vector3d step = scale.asDiagonal() * qr.solve(stacked.rightCols<1>());
  if (!step.allFinite()) return std::nullopt;
  return step;
}

bool update_lens_and_matrices(const Observations& observations, PerspectiveState& state) {
  std::vector<Eigen::Matrix<double, kColumns, kColumns>> triangular;
  for (std::size_t i = 0; i < observations.positions.size(); ++i) {
    const auto equations =
        triangular_equations(observations.positions[i], state.lens, state.matrices[i]);
    if (!equations) return false;
    triangular.push_back(*equations);
  }
  const auto lens = lens_step(triangular);
  if (!lens) return false;
  state.lens.k1_per_mm2 += lens->x();
  state.lens.centre_px += lens->tail<2>();
  for (std::size_t i = 0; i < triangular.size(); ++i) {
    const auto& equations = triangular[i];
    const Eigen::Matrix<double, kOfMatrix, 1> step =
        equations.topLeftCorner<kOfMatrix, kOfMatrix>().triangularView<Eigen::Upper>().solve(
            equations.topRightCorner<kOfMatrix, 1>() -
            equations.block<kOfMatrix, kOfLens>(0, kOfMatrix) * *lens);
    PerspectiveMatrix matrix = state.matrices[i];
    for (Eigen::Index row = 0; row < 3; ++row) {
      matrix.row(row) += step.segment<4>(4 * row).transpose();
    }
    const auto unit = normalised(matrix, observations.positions[i].points.front().object_mm);
    if (!unit) return false;
    state.matrices[i] = *unit;
  }
  return true;
}

double change(const Observations& observations, const PerspectiveState& from,
              const PerspectiveState& to) {
  const double k1 = std::abs(to.lens.k1_per_mm2 - from.lens.k1_per_mm2);
  const double half_width_mm = 0.5 * observations.width * from.lens.pixel_mm.x();
  return std::max({step_size(from.object_from_hand, to.object_from_hand),
                   k1 * half_width_mm * half_width_mm,
                   (to.lens.centre_px - from.lens.centre_px).norm() / observations.width});
}

}  // namespace

std::vector<MatrixPosition> matrix_positions(const Observations& observations,
                                             std::span<const PerspectiveMatrix> matrices) {
  std::vector<MatrixPosition> positions;
  positions.reserve(matrices.size());
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    positions.push_back({matrices[i], observations.positions[i].hand1_from_hand});
  }
  return positions;
}

std::optional<std::vector<PerspectiveMatrix>> matrices_by_dlt(const Observations& observations,
                                                              const SensorLens& lens) {
  std::vector<PerspectiveMatrix> matrices;
  for (const ObservedPosition& position : observations.positions) {
    std::vector<Eigen::Vector3d> points;
    std::vector<Eigen::Vector2d> images;
    for (const ObjectPoint& point : position.points) {
      points.push_back(point.object_mm);
      images.push_back(undistorted_mm(lens, point.pixel));
    }
    const auto matrix = perspective_matrix(points, images);
    if (!matrix) return std::nullopt;
    matrices.push_back(*matrix);
  }
  return matrices;
}

std::optional<PerspectiveState> gauss_newton_step(const Observations& observations,
                                                  const PerspectiveState& state) {
  PerspectiveState next = state;
  if (!update_lens_and_matrices(observations, next)) return std::nullopt;
  const auto positions = matrix_positions(observations, next.matrices);
  const auto object_from_hand = gauss_newton_step(positions, state.object_from_hand);
  if (!object_from_hand) return std::nullopt;
  next.object_from_hand = *object_from_hand;
  return next;
}

std::optional<GaussNewtonResult> gauss_newton(const Observations& observations,
                                              const PerspectiveState& start) {
  GaussNewtonResult result{.state = start, .history = {start}};
  while (result.iterations < kMaxIterations) {
    auto next = gauss_newton_step(observations, result.state);
    if (!next) return std::nullopt;
    const double size = change(observations, result.state, *next);
    result.state = std::move(*next);
    result.history.push_back(result.state);
    ++result.iterations;
    if (size < kConverged) return result;
  }
  return std::nullopt;
}

}  // namespace handeye
