// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/accuracy_chance.hpp"

#include <algorithm>
#include <cstddef>
#include <random>

#include <Eigen/Cholesky>

namespace handeye {
namespace {

constexpr int kDraws = 4000;

/// A truth that the answer may have: R = Exp(w) R_answer, t = t_answer + dt.
Pose drawn_about(const ComparedAnswer& answer, const Matrix6d& root, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 6, 1> white;
  for (double& value : white) value = normal(generator);
  const Eigen::Matrix<double, 6, 1> off = root * white;
  Pose truth = answer.hand_from_eye;
  truth.linear() = exp_so3(off.head<3>()) * truth.linear();
  truth.translation() += off.tail<3>();
  return truth;
}

}  // namespace

Error error_of(const Pose& found, const Pose& truth) {
  return {deg_from_rad(rotation_angle_rad(found.linear(), truth.linear())),
          (found.translation() - truth.translation()).norm()};
}

bool is_worse_than_the_best(const ComparedAnswer& answer, const Pose& truth) {
  if (answer.others.empty()) return false;
  const Error own = error_of(answer.hand_from_eye, truth);
  Error best = error_of(answer.others.front(), truth);
  for (const Pose& other : answer.others) {
    const Error error = error_of(other, truth);
    best.rotation_deg = std::min(best.rotation_deg, error.rotation_deg);
    best.translation_mm = std::min(best.translation_mm, error.translation_mm);
  }
  return own.rotation_deg > best.rotation_deg + answer.sigma_rotation_deg ||
         own.translation_mm > best.translation_mm + answer.sigma_translation_mm;
}

double chance_of_being_worse(const ComparedAnswer& answer) {
  const Matrix6d root = answer.covariance.llt().matrixL();
  std::mt19937 generator(1);
  int worse = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    worse += is_worse_than_the_best(answer, drawn_about(answer, root, generator)) ? 1 : 0;
  }
  return static_cast<double>(worse) / kDraws;
}

double chance_of_so_many(int found, const std::vector<double>& chances) {
  std::vector<double> of_count(chances.size() + 1, 0.0);
  of_count[0] = 1.0;
  for (std::size_t n = 0; n < chances.size(); ++n) {
    for (std::size_t k = n + 1; k > 0; --k) {
      of_count[k] = of_count[k] * (1.0 - chances[n]) + of_count[k - 1] * chances[n];
    }
    of_count[0] *= 1.0 - chances[n];
  }
  double sum = 0;
  for (auto k = static_cast<std::size_t>(found); k < of_count.size(); ++k) sum += of_count[k];
  return sum;
}

}  // namespace handeye
