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

/// The hand, `late_s` further on its way.
Pose moved_on(const HandEstimate& hand, double late_s) {
  Vector6d way;
  way << hand.angular_velocity, hand.velocity;
  return deviated(hand.room_from_hand, late_s * way);
}

Matrix6d sampled_covariance(const HandEstimate& hand, const ActiveCalibration& calibration) {
  const Matrix6d calibration_root = calibration.covariance.llt().matrixL();
  const Matrix6d hand_root = hand.covariance.llt().matrixL();
  const Pose estimate = hand.room_from_hand * calibration.hand_from_eye;
  Noise noise;
  Matrix6d sum = Matrix6d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    const Pose late = moved_on(hand, noise.vector(calibration.time_offset_sigma_s).x());
    const Pose pose = deviated(late, noise.correlated(hand_root)) *
                      deviated(calibration.hand_from_eye, noise.correlated(calibration_root));
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
  calibration.time_offset_sigma_s = 1e-3;
  return calibration;
}

HandEstimate still_hand() {
  HandEstimate hand;
  hand.room_from_hand =
      make_pose(Eigen::Quaterniond(0.3, 0.8, -0.1, 0.5), Eigen::Vector3d(1200, -300, 800));
  hand.covariance = hand_sample_covariance({.rotation_rad = 1e-3, .translation_mm = 0.15});
  return hand;
}

HandEstimate moving_hand() {
  HandEstimate hand = still_hand();
  hand.angular_velocity = {0.5, -0.8, 0.3};
  hand.velocity = {-150, 60, 220};
  return hand;
}

TEST(CameraPoseCovariance, IsThatOfBothNoisesTogether) {
  const ActiveCalibration calibration = some_calibration();
  expect_agree(sampled_covariance(still_hand(), calibration),
               camera_pose_covariance(still_hand(), calibration));
}

TEST(CameraPoseCovariance, TakesAHandThatIsKnownDifferentlyAlongEveryAxis) {
  const ActiveCalibration calibration = some_calibration();
  HandEstimate hand = moving_hand();
  hand.covariance = some_covariance();
  expect_agree(sampled_covariance(hand, calibration), camera_pose_covariance(hand, calibration));
}

TEST(CameraPoseCovariance, OfAMovingScopeCountsTheTimeOffset) {
  ActiveCalibration calibration = some_calibration();
  const Matrix6d moving = camera_pose_covariance(moving_hand(), calibration);
  expect_agree(sampled_covariance(moving_hand(), calibration), moving);
  // The eye's own velocity, which the lever turns into, times 1 ms.
  const HandEstimate hand = moving_hand();
  const Eigen::Vector3d eye_velocity =
      hand.velocity + hand.angular_velocity.cross(hand.room_from_hand.linear() *
                                                  calibration.hand_from_eye.translation());
  const Matrix6d more = moving - camera_pose_covariance(still_hand(), calibration);
  EXPECT_NEAR((more.bottomRightCorner<3, 3>().trace()), 1e-6 * eye_velocity.squaredNorm(), 1e-9);
  EXPECT_NEAR((more.topLeftCorner<3, 3>().trace()), 1e-6 * hand.angular_velocity.squaredNorm(),
              1e-12);
}

TEST(CameraPoseCovariance, OfThePerfectCalibrationIsTheTrackersAlone) {
  ActiveCalibration calibration = some_calibration();
  calibration.covariance = 1e-12 * Matrix6d::Identity();
  const Matrix6d covariance = camera_pose_covariance(still_hand(), calibration);
  expect_agree(sampled_covariance(still_hand(), calibration), covariance);
  // Along the lever of 300 mm the rotation's noise of 1 mrad moves the camera by 0.3 mm.
  const double lever_mm = calibration.hand_from_eye.translation().norm();
  const double expected = 3 * 0.15 * 0.15 + 2 * 1e-6 * lever_mm * lever_mm;
  EXPECT_NEAR((covariance.bottomRightCorner<3, 3>().trace()), expected, 1e-9);
}

TEST(CameraPoseCovariance, OfAPerfectTrackerIsTheCalibrationsTurnedIntoTheRoom) {
  const ActiveCalibration calibration = some_calibration();
  HandEstimate hand = still_hand();
  hand.covariance = 1e-12 * Matrix6d::Identity();
  const Matrix6d covariance = camera_pose_covariance(hand, calibration);
  expect_agree(sampled_covariance(hand, calibration), covariance);
  EXPECT_NEAR(covariance.trace(), calibration.covariance.trace(), 1e-6);
}

}  // namespace
}  // namespace handeye
