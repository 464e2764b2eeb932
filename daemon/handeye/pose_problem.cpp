// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/pose_problem.hpp"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace handeye {
namespace {

constexpr int kMaxIterations = 100;
constexpr double kTolerance = 1e-14;

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Vector6 = Eigen::Matrix<T, 6, 1>;

template <typename T>
Vector3<T> rotation_vector(const Eigen::Quaternion<T>& q) {
  const T wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  Vector3<T> w;
  ceres::QuaternionToAngleAxis(wxyz, w.data());
  return w;
}

template <typename T>
Eigen::Quaternion<T> rotation_by(const Vector3<T>& w) {
  T wxyz[4];
  ceres::AngleAxisToQuaternion(w.data(), wxyz);
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

/// Keeps a correction near zero where the data say nothing.
struct Prior {
  double sigma;
  template <typename T>
  bool operator()(const T* correction, T* residual) const {
    residual[0] = correction[0] / sigma;
    return true;
  }
};

}  // namespace

struct PoseProblem::Residual {
  CentredPose pose;
  Matrix6d whitening;

  template <typename T>
  bool operator()(const T* hand_from_eye, const T* eye_in_hand, const T* room_from_scene,
                  const T* scene_in_room, const T* log_scale, const T* time_offset,
                  T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> rotation_y(hand_from_eye);
    const Eigen::Map<const Vector3<T>> t_y(eye_in_hand);
    const Eigen::Map<const Eigen::Quaternion<T>> rotation_z(room_from_scene);
    const Eigen::Map<const Vector3<T>> t_z(scene_in_room);

    // A larger offset means that the hand was measured earlier: step back along its motion.
    const Vector3<T> turned = -time_offset[0] * pose.angular_velocity.cast<T>();
    const Eigen::Quaternion<T> hand = pose.room_from_hand.cast<T>() * rotation_by<T>(turned);
    const Vector3<T> hand_in_room =
        pose.hand_in_room_mm.cast<T>() - time_offset[0] * pose.velocity.cast<T>();

    using std::exp;
    const Vector3<T> eye_in_room =
        rotation_z * (pose.eye_in_scene_mm.cast<T>() * exp(-log_scale[0])) + t_z;
    const Eigen::Quaternion<T> hand_inverse = hand.conjugate();
    Vector6<T> raw;
    raw.template head<3>() = rotation_vector<T>(
        hand_inverse * rotation_z * pose.scene_from_eye.cast<T>() * rotation_y.conjugate());
    raw.template tail<3>() = hand_inverse * (eye_in_room - hand_in_room) - t_y;
    Eigen::Map<Vector6<T>> whitened(residual);
    whitened = whitening.cast<T>() * raw;
    return true;
  }
};

PoseProblem::PoseProblem(std::span<const HandEyeObservation> observations,
                         const HandEyeSolution& start, const MaximumLikelihoodOptions& options)
    : options_(options),
      start_scale_(start.scale_units_per_mm),
      hand_from_eye_(start.hand_from_eye.linear()),
      eye_in_hand_mm_(start.hand_from_eye.translation()) {
  poses_.reserve(observations.size());
  const auto n = static_cast<double>(observations.size());
  for (const HandEyeObservation& observation : observations) {
    const Pose& hand = observation.poses.room_from_hand;
    const Pose eye = observation.poses.eye_from_scene.inverse();
    poses_.push_back({Eigen::Quaterniond(hand.linear()), hand.translation(),
                      Eigen::Quaterniond(eye.linear()), eye.translation() / start_scale_,
                      observation.hand_angular_velocity, observation.hand_velocity});
    room_centre_mm_ += poses_.back().hand_in_room_mm / n;
    scene_centre_mm_ += poses_.back().eye_in_scene_mm / n;
  }

  // room_from_scene from all poses: the mean of what each says.
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  for (CentredPose& pose : poses_) {
    pose.hand_in_room_mm -= room_centre_mm_;
    pose.eye_in_scene_mm -= scene_centre_mm_;
    rotations +=
        (pose.room_from_hand * hand_from_eye_ * pose.scene_from_eye.conjugate()).toRotationMatrix();
  }
  room_from_scene_ = Eigen::Quaterniond(nearest_rotation(rotations));
  scene_in_room_mm_.setZero();
  for (const CentredPose& pose : poses_) {
    scene_in_room_mm_ += (pose.hand_in_room_mm + pose.room_from_hand * eye_in_hand_mm_ -
                          room_from_scene_ * pose.eye_in_scene_mm) /
                         n;
  }
}

void PoseProblem::solve(const Matrix6d& whitening) {
  ceres::Problem problem;
  for (const CentredPose& pose : poses_) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual, 6, 4, 3, 4, 3, 1, 1>(
                                 new Residual{pose, whitening}),
                             new ceres::HuberLoss(options_.huber), hand_from_eye_.coeffs().data(),
                             eye_in_hand_mm_.data(), room_from_scene_.coeffs().data(),
                             scene_in_room_mm_.data(), &log_scale_, &time_offset_s_);
  }
  problem.SetManifold(hand_from_eye_.coeffs().data(), new ceres::EigenQuaternionManifold);
  problem.SetManifold(room_from_scene_.coeffs().data(), new ceres::EigenQuaternionManifold);
  const auto free_or_fixed = [&](double* correction, bool free, double sigma) {
    if (free) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Prior, 1, 1>(new Prior{sigma}),
                               nullptr, correction);
    } else {
      problem.SetParameterBlockConstant(correction);
    }
  };
  free_or_fixed(&log_scale_, options_.estimate_scale, options_.log_scale_prior);
  free_or_fixed(&time_offset_s_, options_.estimate_time_offset, options_.time_offset_prior_s);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.num_threads = 1;  // two would not give the same answer every time
  solver.max_num_iterations = kMaxIterations;
  solver.function_tolerance = kTolerance;
  solver.parameter_tolerance = kTolerance;
  solver.gradient_tolerance = kTolerance;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
}

std::vector<Vector6d> PoseProblem::residuals() const {
  std::vector<Vector6d> result(poses_.size());
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const Residual residual{poses_[k], Matrix6d::Identity()};
    residual(hand_from_eye_.coeffs().data(), eye_in_hand_mm_.data(),
             room_from_scene_.coeffs().data(), scene_in_room_mm_.data(), &log_scale_,
             &time_offset_s_, result[k].data());
  }
  return result;
}

Eigen::MatrixXd PoseProblem::jacobian(const Matrix6d& whitening) const {
  using Jet = ceres::Jet<double, 14>;
  Eigen::Matrix<double, 6, 14> rows;
  Eigen::MatrixXd result(6 * static_cast<Eigen::Index>(poses_.size()), parameters());
  const auto turned = [](const Eigen::Quaterniond& q, int first) {
    Vector3<Jet> w;
    for (int i = 0; i < 3; ++i) w[i] = Jet(0.0, first + i);
    return Eigen::Quaternion<Jet>(rotation_by<Jet>(w) * q.cast<Jet>());
  };
  const auto moved = [](const Eigen::Vector3d& t, int first) {
    Vector3<Jet> result_t;
    for (int i = 0; i < 3; ++i) result_t[i] = Jet(t[i], first + i);
    return result_t;
  };
  const Eigen::Quaternion<Jet> rotation_y = turned(hand_from_eye_, 0);
  const Vector3<Jet> t_y = moved(eye_in_hand_mm_, 3);
  const Eigen::Quaternion<Jet> rotation_z = turned(room_from_scene_, 6);
  const Vector3<Jet> t_z = moved(scene_in_room_mm_, 9);
  const Jet log_scale(log_scale_, 12);
  const Jet time_offset(time_offset_s_, 13);
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    Vector6<Jet> residual;
    Residual{poses_[k], whitening}(rotation_y.coeffs().data(), t_y.data(),
                                   rotation_z.coeffs().data(), t_z.data(), &log_scale, &time_offset,
                                   residual.data());
    for (int i = 0; i < 6; ++i) rows.row(i) = residual[i].v.transpose();
    const Eigen::Index top = 6 * static_cast<Eigen::Index>(k);
    result.block<6, 12>(top, 0) = rows.leftCols<12>();
    Eigen::Index column = 12;
    if (options_.estimate_scale) result.block<6, 1>(top, column++) = rows.col(12);
    if (options_.estimate_time_offset) result.block<6, 1>(top, column++) = rows.col(13);
  }
  return result;
}

Eigen::Index PoseProblem::parameters() const {
  return 12 + (options_.estimate_scale ? 1 : 0) + (options_.estimate_time_offset ? 1 : 0);
}

HandEyeSolution PoseProblem::solution() const {
  return {make_pose(hand_from_eye_, eye_in_hand_mm_), start_scale_ * std::exp(log_scale_)};
}

Pose PoseProblem::room_from_scene() const {
  // The scene is scaled about its origin, not about the mean of the eyes.
  const Eigen::Vector3d centre_mm = scene_centre_mm_ * std::exp(-log_scale_);
  return make_pose(room_from_scene_,
                   scene_in_room_mm_ + room_centre_mm_ - room_from_scene_ * centre_mm);
}

}  // namespace handeye
