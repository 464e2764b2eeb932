// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/projection_problem.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "daemon/handeye/perspective/lens.hpp"

namespace handeye {
namespace {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

double value_of(double x) {
  return x;
}
template <typename T, int n>
double value_of(const ceres::Jet<T, n>& x) {
  return x.a;
}

bool is_finite(double x) {
  return std::isfinite(x);
}
template <typename T, int n>
bool is_finite(const ceres::Jet<T, n>& x) {
  return std::isfinite(x.a) && x.v.allFinite();
}

/// distorted_radius with its derivatives: one step of Newton's method from the exact value. False
/// where no radius is seen there.
template <typename T>
bool distort_radius(const T& k1_per_mm2, const T& undistorted_mm, T& distorted_mm) {
  const double r = distorted_radius(value_of(k1_per_mm2), value_of(undistorted_mm));
  const T slope = 1.0 + 3.0 * k1_per_mm2 * r * r;
  constexpr double kFold = 1e-3;
  if (!(value_of(slope) > kFold)) return false;
  distorted_mm = r - (r * (1.0 + k1_per_mm2 * r * r) - undistorted_mm) / slope;
  return true;
}

/// Residual of one point, in units of the image noise.
struct ProjectionError {
  ObjectPoint point;
  Pose hand_from_hand1;  // A^-1
  Eigen::Vector2d pixel_mm;
  double image_noise_px;

  template <typename T>
  bool operator()(const T* object_from_hand_q, const T* object_from_hand_t,
                  const T* hand_from_eye_q, const T* hand_from_eye_t, const T* camera,
                  const T* deviation, T* residual) const {
    using Quaternion = Eigen::Quaternion<T>;
    const Vector3<T> in_object = point.object_mm.cast<T>();
    const Vector3<T> in_hand1 =
        Eigen::Map<const Quaternion>(object_from_hand_q).conjugate() *
        Vector3<T>(in_object - Eigen::Map<const Vector3<T>>(object_from_hand_t));
    const Vector3<T> measured =
        hand_from_hand1.linear().cast<T>() * in_hand1 + hand_from_hand1.translation().cast<T>();
    Vector3<T> in_hand;
    ceres::AngleAxisRotatePoint(deviation, measured.data(), in_hand.data());
    in_hand += Eigen::Map<const Vector3<T>>(deviation + 3);
    const Vector3<T> in_eye = Eigen::Map<const Quaternion>(hand_from_eye_q).conjugate() *
                              Vector3<T>(in_hand - Eigen::Map<const Vector3<T>>(hand_from_eye_t));
    if (!(value_of(in_eye.z()) > 0.0)) return false;

    const T& fx = camera[0];
    const T& fy = camera[1];
    const T x_mm = fx * pixel_mm.x() * in_eye.x() / in_eye.z();
    const T y_mm = fy * pixel_mm.y() * in_eye.y() / in_eye.z();
    T ratio(1.0);
    const T r2 = x_mm * x_mm + y_mm * y_mm;
    if (value_of(r2) > 0.0) {
      const T undistorted = sqrt(r2);
      T distorted;
      if (!distort_radius(camera[4], undistorted, distorted)) return false;
      ratio = distorted / undistorted;
    }
    residual[0] = (ratio * x_mm / pixel_mm.x() + camera[2] - point.pixel.x()) / image_noise_px;
    residual[1] = (ratio * y_mm / pixel_mm.y() + camera[3] - point.pixel.y()) / image_noise_px;
    // Ceres would complain on stderr where a residual is not finite; so it is told.
    return is_finite(residual[0]) && is_finite(residual[1]);
  }
};

/// A hand pose's deviation in units of the hand's noise.
struct DeviationError {
  HandNoise noise;

  template <typename T>
  bool operator()(const T* deviation, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      residual[i] = deviation[i] / noise.rotation_rad;
      residual[i + 3] = deviation[i + 3] / noise.translation_mm;
    }
    return true;
  }
};

}  // namespace

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
