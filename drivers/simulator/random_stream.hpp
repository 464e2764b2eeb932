// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Geometry>

namespace handeye::simulator {

/// What a random stream is for. Each purpose has a stream of its own, so that a change in one (a
/// longer recording, another rate) leaves all others as they were.
enum class Purpose : std::uint32_t {
  kRelief = 1,
  kTexture,
  kImageNoise,
  kMotion,
  kRoom,
  kHandEye,
  kCamera,
  kClocks,
  kTrackerNoise,
  kArrivals,
  kWetFilm,
  kFlicker,
  kFieldStop,
  kInstrument,
  kSight,
};

/// Random numbers that depend on seed and purpose alone.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, Purpose purpose) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(purpose)};
    engine_.seed(sequence);
  }

  /// In [low, high).
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  double normal(double sigma) { return sigma * standard_normal_(engine_); }

  /// Never negative.
  double exponential(double mean) {
    return std::exponential_distribution<double>(1.0 / mean)(engine_);
  }

  Eigen::Vector3d normal_vector(double sigma) {
    const double x = normal(sigma);
    const double y = normal(sigma);
    return {x, y, normal(sigma)};
  }

  /// Uniform on the sphere.
  Eigen::Vector3d direction() { return normal_vector(1.0).normalized(); }

  /// Uniform over all rotations (a normal 4-vector has no preferred direction).
  Eigen::Quaterniond rotation() {
    const Eigen::Vector3d xyz = normal_vector(1.0);
    return Eigen::Quaterniond(normal(1.0), xyz.x(), xyz.y(), xyz.z()).normalized();
  }

  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> standard_normal_{0.0, 1.0};
};

}  // namespace handeye::simulator
