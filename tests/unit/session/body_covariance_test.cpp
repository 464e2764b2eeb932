// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/body_covariance.hpp"

#include <limits>
#include <random>
#include <string>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "daemon/session/hand_stream.hpp"
#include "drivers/dtrack/formatter.hpp"

namespace handeye {
namespace {

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& euler_rad) {
  using Eigen::AngleAxisd;
  return (AngleAxisd(euler_rad[0], Eigen::Vector3d::UnitX()) *
          AngleAxisd(euler_rad[1], Eigen::Vector3d::UnitY()) *
          AngleAxisd(euler_rad[2], Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// All six correlated; 0.03 to 0.1 mm, 0.5 to 2 mrad.
Matrix6d correlated(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Vector6d sigma;
  sigma << 0.03, 0.05, 0.1, 0.0005, 0.001, 0.002;
  Matrix6d mix;
  for (double& value : mix.reshaped()) value = normal(random);
  Matrix6d covariance = mix * mix.transpose() + Matrix6d::Identity();
  const Vector6d inverse = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return sigma.asDiagonal() * Matrix6d(inverse.asDiagonal() * covariance * inverse.asDiagonal()) *
         sigma.asDiagonal();
}

dtrack::BodyCovariance said_of(const Matrix6d& covariance, const Eigen::Vector3d& reference_mm) {
  dtrack::BodyCovariance said;
  said.reference_point_mm = reference_mm;
  said.covariance = covariance;
  return said;
}

/// By the definition: the reference point and the angles are drawn, the pose follows.
TEST(BodyCovariance, IsThatOfDrawnPoses) {
  const Eigen::Vector3d lever_in_body_mm(60, -35, 20);
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    std::mt19937 random(100 + seed);
    std::uniform_real_distribution<double> angle(-1.4, 1.4);
    const Eigen::Vector3d euler(2 * angle(random), angle(random), 2 * angle(random));
    Pose truth = Pose::Identity();
    truth.linear() = rotation_of(euler);
    truth.translation() = Eigen::Vector3d(400, -90, 1500);
    const Eigen::Vector3d reference_mm = truth * lever_in_body_mm;
    const Matrix6d covariance = correlated(seed);
    const auto found = covariance_of_body(said_of(covariance, reference_mm), truth);
    ASSERT_TRUE(found);

    const Matrix6d root = covariance.llt().matrixL();
    std::normal_distribution<double> normal;
    Matrix6d sum = Matrix6d::Zero();
    constexpr int kDraws = 40'000;
    for (int i = 0; i < kDraws; ++i) {
      Vector6d white;
      for (double& value : white) value = normal(random);
      const Vector6d error = root * white;
      const Eigen::Matrix3d rotation = rotation_of(euler + error.tail<3>());
      const Eigen::Vector3d origin_mm =
          reference_mm + error.head<3>() - rotation * lever_in_body_mm;
      Vector6d perturbation;
      perturbation << log_so3(rotation * truth.linear().transpose()),
          origin_mm - truth.translation();
      sum += perturbation * perturbation.transpose();
    }
    const Matrix6d drawn = sum / kDraws;
    // Whitened by what was found, the drawn ones are white: within the sampling error.
    const Eigen::LLT<Matrix6d> factor(found->cast<double>());
    ASSERT_EQ(factor.info(), Eigen::Success);
    const Matrix6d half = factor.matrixL().solve(drawn);
    const Matrix6d white = factor.matrixL().solve(half.transpose());
    EXPECT_LT((white - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 0.05) << seed << '\n' << white;
  }
}

TEST(BodyCovariance, WithoutLeverThePositionIsAsSaid) {
  Matrix6d covariance = correlated(7);
  covariance.topRightCorner<3, 3>().setZero();
  covariance.bottomLeftCorner<3, 3>().setZero();
  const auto found =
      covariance_of_body(said_of(covariance, Eigen::Vector3d::Zero()), Pose::Identity());
  ASSERT_TRUE(found);
  const Matrix6d as_said = found->cast<double>();
  EXPECT_TRUE((as_said.bottomRightCorner<3, 3>()).isApprox(covariance.topLeftCorner<3, 3>(), 1e-5));
  // At the identity the three angles are w itself.
  EXPECT_TRUE((as_said.topLeftCorner<3, 3>()).isApprox(covariance.bottomRightCorner<3, 3>(), 1e-5));
  EXPECT_LT((as_said.topRightCorner<3, 3>()).norm(), 1e-12);
}

TEST(BodyCovariance, WhatCannotBeMeantIsNotTaken) {
  const Pose at_origin = Pose::Identity();
  const auto taken = [&](const Matrix6d& covariance, double reference_mm = 0) {
    return covariance_of_body(said_of(covariance, {reference_mm, 0, 0}), at_origin).has_value();
  };
  const Matrix6d good = correlated(3);
  EXPECT_TRUE(taken(good));
  EXPECT_FALSE(taken(Matrix6d::Zero())) << "0 is no variance";
  EXPECT_FALSE(taken(-good));
  EXPECT_FALSE(taken(1e8 * good)) << "metres";
  EXPECT_FALSE(taken(1e-9 * good));
  EXPECT_FALSE(taken(good, 5000)) << "a reference point in another room";
  EXPECT_FALSE(taken(good, std::numeric_limits<double>::quiet_NaN()));
  Matrix6d bad = good;
  bad(0, 1) = bad(1, 0) = 2 * std::sqrt(bad(0, 0) * bad(1, 1));
  EXPECT_FALSE(taken(bad)) << "a correlation of 2";
  bad = good;
  bad(2, 5) = bad(5, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(taken(bad));
}

/// Three printed digits may take the last bit of definiteness; that is no reason to drop it.
TEST(BodyCovariance, RoundingIsMended) {
  Matrix6d covariance = correlated(5);
  covariance.row(1) = covariance.row(0);
  covariance.col(1) = covariance.col(0);
  covariance(1, 1) = covariance(0, 0) * 0.9995;  // now x and y are one, but for the last digit
  const auto found =
      covariance_of_body(said_of(covariance, Eigen::Vector3d(10, 0, 0)), Pose::Identity());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cast<double>().llt().info(), Eigen::Success);
}

TEST(BodyCovariance, ComesWithTheSampleOfItsBody) {
  HandStream stream(2);
  Matrix6d found = Matrix6d::Zero();
  for (std::uint32_t k = 0; k < 6; ++k) {
    dtrack::Frame frame;
    frame.number = k;
    frame.seconds_of_day = 500.0 + k / 60.0;
    dtrack::Body body;
    body.id = 2;
    body.tracked = true;
    body.quality = 1;
    body.room_from_body.translation() = Eigen::Vector3d(100, 200, 300);
    frame.bodies.push_back(body);
    dtrack::BodyCovariance said = said_of(correlated(1), Eigen::Vector3d(100, 200, 300));
    said.id = 2;
    if (k == 4) said.covariance *= -1;
    frame.covariances.push_back(said);
    std::string text;
    dtrack::format_datagram(frame, text);
    const auto sample = stream.take({1'000'000'000 + k * std::int64_t{16'666'667}, text});
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->covariance.has_value(), k != 4);
    if (sample->covariance) found = sample->covariance->cast<double>();
  }
  EXPECT_EQ(stream.bad_covariances(), 1U);
  const Matrix6d expected = correlated(1);
  EXPECT_TRUE((found.bottomRightCorner<3, 3>()).isApprox(expected.topLeftCorner<3, 3>(), 2e-3));
}

}  // namespace
}  // namespace handeye
