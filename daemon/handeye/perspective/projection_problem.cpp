// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/projection_problem.hpp"

#include <limits>
#include <numeric>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <ceres/ceres.h>

#include "daemon/handeye/perspective/projection_error.hpp"

namespace handeye {
/// Ceres' problem over the members, with weights and fixed blocks.
struct ProjectionProblem::Weighted {
  ceres::Problem problem;

  Weighted(ProjectionProblem& of, Hands hands, double image_noise_px, const HandNoise& hand_noise) {
    for (std::size_t i = 0; i < of.deviations_.size(); ++i) {
      const ObservedPosition& position = of.observations_.positions[i];
      const Pose hand_from_hand1 = position.hand1_from_hand.inverse();
      for (const ObjectPoint& point : position.points) {
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<ProjectionError, 2, 4, 3, 4, 3, 5, 6>(
                new ProjectionError{point, hand_from_hand1, of.observations_.pixel_mm,
                                    image_noise_px}),
            nullptr, of.object_from_hand_q_.coeffs().data(), of.object_from_hand_t_.data(),
            of.hand_from_eye_q_.coeffs().data(), of.hand_from_eye_t_.data(), of.camera_.data(),
            of.deviations_[i].data());
      }
      if (hands == Hands::kNoisy) {
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<DeviationError, 6, 6>(new DeviationError{hand_noise}),
            nullptr, of.deviations_[i].data());
      }
      if (hands == Hands::kExact) problem.SetParameterBlockConstant(of.deviations_[i].data());
    }
    for (Eigen::Quaterniond* q : {&of.object_from_hand_q_, &of.hand_from_eye_q_}) {
      problem.SetManifold(q->coeffs().data(), new ceres::EigenQuaternionManifold);
    }
    if (!of.distortion_inside_) {
      problem.SetManifold(of.camera_.data(), new ceres::SubsetManifold(5, {4}));
    }
    if (hands == Hands::kFree) {
      for (double* block : of.pose_blocks()) problem.SetParameterBlockConstant(block);
    }
  }
};

ProjectionProblem::ProjectionProblem(const Observations& observations,
                                     const RefinedCalibration& start, bool distortion_inside)
    : observations_(observations),
      distortion_inside_(distortion_inside),
      object_from_hand_q_(start.object_from_hand.linear()),
      hand_from_eye_q_(start.hand_from_eye.linear()),
      object_from_hand_t_(start.object_from_hand.translation()),
      hand_from_eye_t_(start.hand_from_eye.translation()),
      deviations_(observations.positions.size(), Vector6d::Zero()) {
  const PerspectiveCamera& c = start.camera;
  camera_ << c.fx, c.fy, c.cx, c.cy, distortion_inside ? c.k1_per_mm2 : 0.0;
}

std::array<double*, 4> ProjectionProblem::pose_blocks() {
  return {object_from_hand_q_.coeffs().data(), object_from_hand_t_.data(),
          hand_from_eye_q_.coeffs().data(), hand_from_eye_t_.data()};
}

bool ProjectionProblem::solve(Hands hands, double image_noise_px, const HandNoise& hand_noise) {
  if (!errors_px()) return false;
  Weighted weighted(*this, hands, image_noise_px, hand_noise);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  if (hands != Hands::kExact) options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-13;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &weighted.problem, &summary);
  return summary.IsSolutionUsable();
}

RefinedCalibration ProjectionProblem::calibration() const {
  RefinedCalibration calibration;
  calibration.object_from_hand = make_pose(object_from_hand_q_, object_from_hand_t_);
  calibration.hand_from_eye = make_pose(hand_from_eye_q_, hand_from_eye_t_);
  calibration.camera = {camera_(0), camera_(1), camera_(2), camera_(3), camera_(4)};
  return calibration;
}

std::optional<std::vector<double>> ProjectionProblem::errors_px() const {
  std::vector<double> errors;
  errors.reserve(observations_.point_count());
  for (std::size_t i = 0; i < deviations_.size(); ++i) {
    const ObservedPosition& position = observations_.positions[i];
    const Pose hand_from_hand1 = position.hand1_from_hand.inverse();
    for (const ObjectPoint& point : position.points) {
      const ProjectionError error{point, hand_from_hand1, observations_.pixel_mm, 1.0};
      Eigen::Vector2d residual;
      if (!error(object_from_hand_q_.coeffs().data(), object_from_hand_t_.data(),
                 hand_from_eye_q_.coeffs().data(), hand_from_eye_t_.data(), camera_.data(),
                 deviations_[i].data(), residual.data())) {
        return std::nullopt;
      }
      errors.push_back(residual.norm());
    }
  }
  return errors;
}

double ProjectionProblem::sum_of_squares_px2() const {
  const auto errors = errors_px();
  if (!errors) return std::numeric_limits<double>::infinity();
  return std::inner_product(errors->begin(), errors->end(), errors->begin(), 0.0);
}

Eigen::Index ProjectionProblem::image_residuals() const {
  return 2 * static_cast<Eigen::Index>(observations_.point_count());
}

Eigen::Vector2d ProjectionProblem::sum_of_square_deviations() const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Vector6d& d : deviations_) {
    sum += Eigen::Vector2d(d.head<3>().squaredNorm(), d.tail<3>().squaredNorm());
  }
  return sum;
}

void ProjectionProblem::clear_deviations() {
  for (Vector6d& deviation : deviations_) deviation.setZero();
}

std::optional<Eigen::MatrixXd> ProjectionProblem::covariance(Hands hands, double image_noise_px,
                                                             const HandNoise& hand_noise) {
  Weighted weighted(*this, hands, image_noise_px, hand_noise);
  ceres::Problem::EvaluateOptions options;
  for (double* block : pose_blocks()) options.parameter_blocks.push_back(block);
  options.parameter_blocks.push_back(camera_.data());
  if (hands == Hands::kNoisy) {
    for (Vector6d& deviation : deviations_) options.parameter_blocks.push_back(deviation.data());
  }
  ceres::CRSMatrix jacobian;
  if (!weighted.problem.Evaluate(options, nullptr, nullptr, nullptr, &jacobian)) {
    return std::nullopt;
  }
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> j(
      jacobian.num_rows, jacobian.num_cols, static_cast<Eigen::Index>(jacobian.values.size()),
      jacobian.rows.data(), jacobian.cols.data(), jacobian.values.data());
  const Eigen::SparseMatrix<double> product = j.transpose() * j;
  const Eigen::MatrixXd information = product;
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * information *
                                                             scale.asDiagonal());
  constexpr double kNotDetermined = 1e-14;
  if (!(eigen.eigenvalues()(0) > kNotDetermined)) return std::nullopt;
  const Eigen::MatrixXd inverse = scale.asDiagonal() * eigen.eigenvectors() *
                                  eigen.eigenvalues().cwiseInverse().asDiagonal() *
                                  eigen.eigenvectors().transpose() * scale.asDiagonal();
  Eigen::MatrixXd covariance = inverse.topLeftCorner(unknowns(), unknowns());
  // Ceres' tangent of a quaternion is half the rotation vector.
  for (const Eigen::Index rotation : {0, 6}) {
    covariance.middleRows<3>(rotation) *= 2.0;
    covariance.middleCols<3>(rotation) *= 2.0;
  }
  return covariance;
}

}  // namespace handeye
