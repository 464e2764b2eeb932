// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/perspective_matrix.hpp"

#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// Moves points to their mean and scales them to rms 1 (Hartley): DLT is badly scaled without.
template <int size>
struct Conditioning {
  Eigen::Matrix<double, size, 1> mean{Eigen::Matrix<double, size, 1>::Zero()};
  double scale{1.0};

  explicit Conditioning(std::span<const Eigen::Matrix<double, size, 1>> points) {
    for (const auto& point : points) mean += point;
    mean /= static_cast<double>(points.size());
    double square = 0.0;
    for (const auto& point : points) square += (point - mean).squaredNorm();
    scale = std::sqrt(square / static_cast<double>(points.size()));
  }

  Eigen::Matrix<double, size, 1> operator()(const Eigen::Matrix<double, size, 1>& point) const {
    return (point - mean) / scale;
  }

  Eigen::Matrix<double, size + 1, size + 1> matrix() const {
    Eigen::Matrix<double, size + 1, size + 1> m;
    m.setIdentity();
    m.template topLeftCorner<size, size>() /= scale;
    m.template topRightCorner<size, 1>() = -mean / scale;
    return m;
  }
};

Eigen::Vector3d mean_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point;
  return mean / static_cast<double>(points.size());
}

}  // namespace

std::optional<PerspectiveMatrix> normalised(const PerspectiveMatrix& matrix,
                                            const Eigen::Vector3d& in_front) {
  const double norm = matrix.row(2).head<3>().norm();
  if (!std::isnormal(norm) || !matrix.allFinite()) return std::nullopt;
  const double depth = matrix.row(2).dot(in_front.homogeneous().transpose());
  return PerspectiveMatrix(matrix / (depth < 0.0 ? -norm : norm));
}

std::optional<PerspectiveMatrix> perspective_matrix(std::span<const Eigen::Vector3d> points_mm,
                                                    std::span<const Eigen::Vector2d> images_mm) {
  const auto count = static_cast<Eigen::Index>(points_mm.size());
  if (points_mm.size() < kMinPointsForMatrix || points_mm.size() != images_mm.size() ||
      coplanar(points_mm)) {
    return std::nullopt;
  }
  const Conditioning<3> object(points_mm);
  const Conditioning<2> image(images_mm);
  if (!std::isnormal(object.scale) || !std::isnormal(image.scale)) return std::nullopt;
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(2 * count, 12);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::RowVector4d point = object(points_mm[k]).homogeneous().transpose();
    const Eigen::Vector2d x = image(images_mm[k]);
    equations.block<1, 4>(2 * i, 0) = point;
    equations.block<1, 4>(2 * i, 8) = -x.x() * point;
    equations.block<1, 4>(2 * i + 1, 4) = point;
    equations.block<1, 4>(2 * i + 1, 8) = -x.y() * point;
  }
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(equations, Eigen::ComputeThinV);
  // Two null directions: more than one matrix explains the images.
  constexpr double kSingular = 1e-9;
  if (!(svd.singularValues()(10) > kSingular * svd.singularValues()(0))) return std::nullopt;
  const Eigen::Matrix<double, 12, 1> m = svd.matrixV().col(11);
  PerspectiveMatrix conditioned;
  conditioned << m.head<4>().transpose(), m.segment<4>(4).transpose(), m.tail<4>().transpose();
  return normalised(image.matrix().inverse() * conditioned * object.matrix(), object.mean);
}

std::optional<Decomposition> decompose(const PerspectiveMatrix& matrix) {
  const Eigen::Matrix3d n = matrix.leftCols<3>();
  if (!n.allFinite() || !(n.determinant() > 0.0)) return std::nullopt;
  // N^-1 = R^T K^-1: a QR decomposition.
  const Eigen::HouseholderQR<Eigen::Matrix3d> qr(n.inverse());
  Eigen::Matrix3d rotation = Eigen::Matrix3d(qr.householderQ()).transpose();
  Eigen::Matrix3d inverse = qr.matrixQR().triangularView<Eigen::Upper>();
  const Eigen::Vector3d sign = inverse.diagonal().cwiseSign();
  rotation = sign.asDiagonal() * rotation;
  inverse = sign.asDiagonal() * inverse;
  const Eigen::Matrix3d k = inverse.inverse();
  Decomposition parts{.intrinsics = k / k(2, 2), .eye_from_object = Pose::Identity()};
  parts.eye_from_object.linear() = rotation;
  parts.eye_from_object.translation() = inverse * matrix.col(3);
  if (!parts.intrinsics.allFinite() || !parts.eye_from_object.matrix().allFinite()) {
    return std::nullopt;
  }
  return parts;
}

PerspectiveMatrix compose(const Eigen::Matrix3d& intrinsics, const Pose& eye_from_object) {
  return intrinsics * eye_from_object.matrix().topRows<3>();
}

bool coplanar(std::span<const Eigen::Vector3d> points_mm) {
  if (points_mm.size() < 4) return true;
  const Eigen::Vector3d mean = mean_of(points_mm);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points_mm) {
    scatter += (point - mean) * (point - mean).transpose();
  }
  const Eigen::Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
  constexpr double kFlat = 1e-3;
  return !(squares(0) > kFlat * kFlat * squares(2));
}

}  // namespace handeye
