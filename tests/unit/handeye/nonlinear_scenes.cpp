// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/nonlinear_scenes.hpp"

#include <cmath>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/selection.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye::synthetic {

double Random::uniform(double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(generator_);
}

double Random::power_of_ten(double from, double to) {
  return std::pow(10.0, uniform(from, to));
}

double Random::normal() {
  return std::normal_distribution<double>()(generator_);
}

Eigen::Vector3d Random::normal3() {
  const double x = normal();
  const double y = normal();
  return {x, y, normal()};
}

Eigen::Quaterniond Random::quaternion() {
  const Eigen::Vector3d imaginary = normal3();
  return {normal(), imaginary.x(), imaginary.y(), imaginary.z()};
}

HandEyeSolution random_solution(Random& random, double length_mm, double scale_units_per_mm) {
  HandEyeSolution solution;
  solution.hand_from_eye.linear() = exp_so3(1.5 * random.normal3());
  solution.hand_from_eye.translation() = length_mm * random.normal3();
  solution.scale_units_per_mm = scale_units_per_mm;
  return solution;
}

Movement exact_movement(const HandEyeSolution& truth, Random& random, double angle_rad,
                        double length_mm) {
  Movement movement;
  movement.hand_j_from_hand_i.linear() = exp_so3(angle_rad * random.normal3().normalized());
  movement.hand_j_from_hand_i.translation() = length_mm * random.normal3();
  movement.eye_j_from_eye_i =
      truth.hand_from_eye.inverse() * movement.hand_j_from_hand_i * truth.hand_from_eye;
  movement.eye_j_from_eye_i.translation() *= truth.scale_units_per_mm;
  return movement;
}

std::vector<Movement> random_movements(const HandEyeSolution& truth, Random& random, int trial) {
  const int n = 4 + trial % 20;
  const double length_mm = random.power_of_ten(1, 3.5);
  std::vector<Movement> movements;
  for (int k = 0; k < n; ++k) {
    const bool half_turn = trial % 3 == 0 || (trial % 3 == 1 && k % 2 == 0);
    const double off_rad = random.power_of_ten(-6, -1);
    const double angle_rad =
        half_turn ? kPi + (k % 4 < 2 ? -off_rad : off_rad) : random.uniform(0.1, kPi - 1e-6);
    movements.push_back(exact_movement(truth, random, angle_rad, length_mm));
  }
  return movements;
}

double condition_of(const std::vector<Movement>& movements, const HandEyeSolution& truth) {
  const Eigen::Matrix3d eye_from_hand = truth.hand_from_eye.linear().transpose();
  Eigen::MatrixXd matrix(3 * static_cast<Eigen::Index>(movements.size()), 4);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    const auto& [hand, eye] = movements[k];
    matrix.middleRows<3>(3 * static_cast<Eigen::Index>(k))
        << Eigen::Matrix3d::Identity() - eye.linear(),
        eye_from_hand * hand.translation();
  }
  matrix.colwise().normalize();
  const Eigen::VectorXd singular = right_singular(matrix).values;
  return singular[0] / singular[3];
}

std::vector<Movement> noisy_movements(double scale_units_per_mm, std::uint32_t seed) {
  const Recording recording =
      record(scope(scale_units_per_mm), free_hand, 150, tracker_and_camera(), seed);
  return select_movements(recording.poses()).movements;
}

}  // namespace handeye::synthetic
