// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/factorisation.hpp"

#include <Eigen/Eigenvalues>

namespace handeye {

AffineFactorisation factorise(const Eigen::MatrixXd& rays) {
  AffineFactorisation result;
  // (F1) The centroid's image is the mean of the images.
  result.centroid = rays.rowwise().mean();
  const Eigen::MatrixXd registered = rays.colwise() - result.centroid;

  // (F2) W = U Sigma V^T. U and Sigma from the small 2F x 2F matrix W W^T, many times cheaper than
  // the SVD of W. It squares the singular values: what is below 1e-8 of the largest is lost, but
  // the noise of any image lies far above that.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(registered * registered.transpose());
  const Eigen::Vector4d squared = eigen.eigenvalues().tail<4>().reverse();
  result.sigma = squared.cwiseMax(0.0).cwiseSqrt();

  // (F3) M^ = U_3 Sigma_3^(1/2), S^ = Sigma_3^(-1/2) U_3^T W = Sigma_3^(1/2) V_3^T.
  const Eigen::MatrixXd basis = eigen.eigenvectors().rightCols<3>().rowwise().reverse();
  const double smallest = 1e-12 * result.sigma(0) + 1e-300;
  const Eigen::Vector3d root = result.sigma.head<3>().cwiseMax(smallest).cwiseSqrt();
  result.motion = basis * root.asDiagonal();
  result.shape = root.cwiseInverse().asDiagonal() * (basis.transpose() * registered);
  return result;
}

}  // namespace handeye
