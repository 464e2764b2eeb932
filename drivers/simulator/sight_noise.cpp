// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/sight_noise.hpp"

#include <cmath>

namespace handeye::simulator {
namespace {

/// Of the standard deviation per axis; the mean of the squares is 1.
const Eigen::Vector3d kTranslationShares(0.6, 0.6, 1.5100);
const Eigen::Vector3d kRotationShares(1.2, 1.2, 0.3464);

/// At the worst so many times the standard deviation of the best.
constexpr double kWorstOfBest = 3.0;

RandomStream stream_of(std::uint64_t seed) {
  return {seed, Purpose::kSight};
}

}  // namespace

SightNoise::SightNoise(std::uint64_t seed, double rotation_rad, double translation_mm)
    : rotation_rad_(rotation_rad), translation_mm_(translation_mm), visibility_([seed] {
        RandomStream random = stream_of(seed);
        return Wander(random);
      }()) {
  RandomStream random = stream_of(~seed);
  room_from_sight_ = random.rotation().toRotationMatrix();
}

double SightNoise::worse(double time_s) const {
  // Equally far above and below 1 in proportion.
  return std::pow(kWorstOfBest, 0.5 * visibility_.at(3 * time_s));
}

Matrix6d SightNoise::covariance(double time_s) const {
  const double scale = worse(time_s);
  const Eigen::Vector3d rotation = scale * rotation_rad_ * kRotationShares;
  const Eigen::Vector3d translation = scale * translation_mm_ * kTranslationShares;
  Matrix6d covariance = Matrix6d::Zero();
  covariance.topLeftCorner<3, 3>() = room_from_sight_ *
                                     rotation.array().square().matrix().asDiagonal() *
                                     room_from_sight_.transpose();
  covariance.bottomRightCorner<3, 3>() = room_from_sight_ *
                                         translation.array().square().matrix().asDiagonal() *
                                         room_from_sight_.transpose();
  return covariance;
}

Pose SightNoise::measure(const Pose& room_from_body, double time_s, RandomStream& random) const {
  const double scale = worse(time_s);
  const Eigen::Vector3d w =
      scale * rotation_rad_ * kRotationShares.cwiseProduct(random.normal_vector(1.0));
  const Eigen::Vector3d dt =
      scale * translation_mm_ * kTranslationShares.cwiseProduct(random.normal_vector(1.0));
  Pose measured = room_from_body;
  measured.linear() = exp_so3(room_from_sight_ * w) * room_from_body.linear();
  measured.translation() += room_from_sight_ * dt;
  return measured;
}

Matrix6d euler_covariance(const Matrix6d& room_covariance,
                          const Eigen::Vector3d& euler_angles_rad) {
  const Eigen::AngleAxisd about_x(euler_angles_rad.x(), Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd about_y(euler_angles_rad.y(), Eigen::Vector3d::UnitY());
  Eigen::Matrix3d w_from_angles;
  w_from_angles << Eigen::Vector3d::UnitX(), about_x * Eigen::Vector3d::UnitY(),
      about_x * (about_y * Eigen::Vector3d::UnitZ());
  Matrix6d wire_from_room = Matrix6d::Zero();
  wire_from_room.topRightCorner<3, 3>().setIdentity();
  wire_from_room.bottomLeftCorner<3, 3>() = w_from_angles.inverse();
  return wire_from_room * room_covariance * wire_from_room.transpose();
}

}  // namespace handeye::simulator
