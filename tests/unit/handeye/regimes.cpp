// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/regimes.hpp"

#include <array>
#include <cmath>
#include <random>

namespace handeye::synthetic {
namespace {

constexpr PoseNoise noise(double hand_deg, double hand_mm, double eye_deg, double eye_mm) {
  return {rad_from_deg(hand_deg), hand_mm, rad_from_deg(eye_deg), eye_mm};
}

constexpr PoseNoise kTracked = noise(0.06, 0.15, 0.03, 0.1);

constexpr std::array<Regime, 11> kRegimes{{
    {"tracked scope", 40, 20, 15, 300, kTracked},
    {"the tracker errs", 40, 20, 15, 300, noise(0.2, 0.5, 0.01, 0.02)},
    {"the camera errs", 40, 20, 15, 300, noise(0.01, 0.02, 0.2, 0.5)},
    {"rotations err", 40, 20, 50, 100, noise(0.3, 0.02, 0.3, 0.02)},
    {"positions err", 40, 20, 50, 100, noise(0.01, 1, 0.01, 1)},
    {"turns of +-5 deg", 40, 5, 15, 300, kTracked},
    {"turns of +-60 deg", 40, 60, 100, 300, kTracked},
    {"lever arm of 20 mm", 40, 20, 15, 20, kTracked},
    {"15 poses", 15, 20, 15, 300, kTracked},
    {"robot, +-500 mm", 20, 60, 500, 100, noise(0.02, 0.05, 0.2, 1.0)},
    {"200 poses", 200, 20, 15, 300, kTracked},
}};

}  // namespace

std::span<const Regime> regimes() {
  return kRegimes;
}

RegimeSample sample(const Regime& regime, std::uint32_t seed, double scale_units_per_mm) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto normal3 = [&] {
    const double x = normal(generator);
    const double y = normal(generator);
    return Eigen::Vector3d(x, y, normal(generator));
  };
  const auto uniform3 = [&] {
    const double x = uniform(generator);
    const double y = uniform(generator);
    return Eigen::Vector3d(x, y, uniform(generator));
  };

  RegimeSample result;
  Truth& truth = result.truth;
  truth.solution.hand_from_eye.linear() = exp_so3(1.5 * normal3());
  truth.solution.hand_from_eye.translation() = regime.lever_arm_mm * normal3().normalized();
  truth.solution.scale_units_per_mm = scale_units_per_mm;
  truth.room_from_scene.linear() = exp_so3(1.5 * normal3());
  truth.room_from_scene.translation() = 300 * normal3();
  const Eigen::Matrix3d attitude = exp_so3(1.5 * normal3());
  const Eigen::Vector3d place(400, -300, 900);
  for (int k = 0; k < regime.poses; ++k) {
    Pose room_from_eye = Pose::Identity();
    room_from_eye.linear() = attitude * exp_so3(rad_from_deg(regime.turn_deg) * uniform3());
    room_from_eye.translation() = place + regime.shift_mm * uniform3();
    const Pose hand = room_from_eye * truth.solution.hand_from_eye.inverse();
    Pose scene_from_eye = truth.room_from_scene.inverse() * room_from_eye;
    result.room_from_hand.push_back(hand);

    PosePair pair;
    pair.room_from_hand.linear() =
        hand.linear() * exp_so3(regime.noise.hand_rotation_rad * normal3());
    pair.room_from_hand.translation() =
        hand.translation() + regime.noise.hand_translation_mm * normal3();
    scene_from_eye.linear() =
        scene_from_eye.linear() * exp_so3(regime.noise.eye_rotation_rad * normal3());
    scene_from_eye.translation() += regime.noise.eye_translation_mm * normal3();
    scene_from_eye.translation() *= scale_units_per_mm;
    pair.eye_from_scene = scene_from_eye.inverse();
    result.poses.push_back(pair);
  }
  return result;
}

void RmsError::add(const Vector6d& error) {
  rotation_square_ += error.head<3>().squaredNorm();
  translation_square_ += error.tail<3>().squaredNorm();
  ++count_;
}

double RmsError::rotation_deg() const {
  return deg_from_rad(std::sqrt(rotation_square_ / count_));
}

double RmsError::translation_mm() const {
  return std::sqrt(translation_square_ / count_);
}

}  // namespace handeye::synthetic
