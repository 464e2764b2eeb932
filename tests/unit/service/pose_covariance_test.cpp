// SPDX-License-Identifier: BSD-3-Clause
// camera_pose_covariance against drawing the noise and looking.
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "daemon/service/pose_publisher.hpp"

namespace handeye {
namespace {

constexpr int kDraws = 20'000;

class Noise {
 public:
  Eigen::Vector3d vector(double sigma) {
    return sigma * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_));
  }
  Vector6d correlated(const Matrix6d& square_root) {
    Vector6d unit;
    unit << vector(1), vector(1);
    return square_root * unit;
  }

 private:
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

/// (w, dt) with R = Exp(w) R_estimate, t = t_estimate + dt.
Vector6d deviation(const Pose& pose, const Pose& estimate) {
  Vector6d result;
  result << log_so3(pose.linear() * estimate.linear().transpose()),
      pose.translation() - estimate.translation();
  return result;
}

Pose deviated(const Pose& estimate, const Vector6d& by) {
  Pose pose = estimate;
  pose.linear() = exp_so3(by.head<3>()) * estimate.linear();
  pose.translation() += by.tail<3>();
  return pose;
}

/// Correlated, and different along every axis: a wrong rotation of a block would show.
Matrix6d some_covariance() {
  Matrix6d square_root = Matrix6d::Zero();
  for (int row = 0; row < 6; ++row) {
    const double scale = row < 3 ? 1e-3 : 0.4;
    for (int column = 0; column <= row; ++column) {
      square_root(row, column) = scale * (row == column ? 1.0 + 0.5 * row : 0.4 - 0.2 * column);
    }
  }
  return square_root * square_root.transpose();
}

Matrix6d sampled_covariance(const Pose& room_from_hand, const ActiveCalibration& calibration) {
  const Matrix6d square_root = calibration.covariance.llt().matrixL();
  const Pose estimate = room_from_hand * calibration.hand_from_eye;
  Noise noise;
  Matrix6d sum = Matrix6d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Vector6d hand_noise;
    hand_noise << noise.vector(calibration.hand_rotation_sigma_rad),
        noise.vector(calibration.hand_translation_sigma_mm);
    const Pose pose = deviated(room_from_hand, hand_noise) *
                      deviated(calibration.hand_from_eye, noise.correlated(square_root));
    const Vector6d by = deviation(pose, estimate);
    sum += by * by.transpose();
  }
  return sum / kDraws;
}

void expect_agree(const Matrix6d& sampled, const Matrix6d& predicted) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      // Standard deviation of a sampled covariance of Gaussian variables.
      const double sigma = std::sqrt(
          (predicted(i, i) * predicted(j, j) + predicted(i, j) * predicted(i, j)) / kDraws);
      EXPECT_NEAR(sampled(i, j), predicted(i, j), 5 * sigma) << i << ' ' << j;
    }
  }
}

ActiveCalibration some_calibration() {
  ActiveCalibration calibration;
  calibration.hand_from_eye =
      make_pose(Eigen::Quaterniond(0.4, -0.5, 0.7, 0.2), Eigen::Vector3d(60, -40, 300));
  calibration.covariance = some_covariance();
  calibration.hand_rotation_sigma_rad = 1e-3;
  calibration.hand_translation_sigma_mm = 0.15;
  return calibration;
}

const Pose kRoomFromHand =
    make_pose(Eigen::Quaterniond(0.3, 0.8, -0.1, 0.5), Eigen::Vector3d(1200, -300, 800));

TEST(CameraPoseCovariance, IsThatOfBothNoisesTogether) {
  const ActiveCalibration calibration = some_calibration();
  expect_agree(sampled_covariance(kRoomFromHand, calibration),
               camera_pose_covariance(kRoomFromHand, calibration));
}

TEST(CameraPoseCovariance, OfThePerfectCalibrationIsTheTrackersAlone) {
  ActiveCalibration calibration = some_calibration();
  calibration.covariance = 1e-12 * Matrix6d::Identity();
  const Matrix6d covariance = camera_pose_covariance(kRoomFromHand, calibration);
  expect_agree(sampled_covariance(kRoomFromHand, calibration), covariance);
  // Along the lever of 300 mm the rotation's noise of 1 mrad moves the camera by 0.3 mm.
  const double lever_mm = calibration.hand_from_eye.translation().norm();
  const double expected = 3 * 0.15 * 0.15 + 2 * 1e-6 * lever_mm * lever_mm;
  EXPECT_NEAR((covariance.bottomRightCorner<3, 3>().trace()), expected, 1e-9);
}

TEST(CameraPoseCovariance, OfAPerfectTrackerIsTheCalibrationsTurnedIntoTheRoom) {
  ActiveCalibration calibration = some_calibration();
  calibration.hand_rotation_sigma_rad = 0;
  calibration.hand_translation_sigma_mm = 0;
  const Matrix6d covariance = camera_pose_covariance(kRoomFromHand, calibration);
  expect_agree(sampled_covariance(kRoomFromHand, calibration), covariance);
  EXPECT_NEAR(covariance.trace(), calibration.covariance.trace(), 1e-9);
}

}  // namespace
}  // namespace handeye
