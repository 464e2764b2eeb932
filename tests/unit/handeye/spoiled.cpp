// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/spoiled.hpp"

#include <algorithm>
#include <numeric>

namespace handeye::synthetic {
namespace {

Eigen::Vector3d normal3(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const double x = normal(generator);
  const double y = normal(generator);
  return {x, y, normal(generator)};
}

void spoil(PosePair& pair, Spoiling spoiling, double scale, const Pose& same,
           std::mt19937& generator) {
  switch (spoiling) {
    case Spoiling::kRandomHand:
      pair.room_from_hand.linear() = exp_so3(1.5 * normal3(generator));
      pair.room_from_hand.translation() = 200 * normal3(generator);
      break;
    case Spoiling::kEyeTranslation:
      pair.eye_from_scene.translation() += scale * 30 * normal3(generator);
      break;
    case Spoiling::kEyeRotation:
      pair.eye_from_scene.linear() =
          exp_so3(rad_from_deg(5) * normal3(generator)) * pair.eye_from_scene.linear();
      break;
    case Spoiling::kSwappedMarkers:
      pair.room_from_hand = pair.room_from_hand * same;
      break;
    case Spoiling::kStuckHand:
      pair.room_from_hand = same;
      break;
    case Spoiling::kHandJump:
      pair.room_from_hand.translation().x() += 2000;
      break;
  }
}

}  // namespace

void add_noise(std::vector<PosePair>& poses, const PoseNoise& noise, double scale_units_per_mm,
               std::mt19937& generator) {
  for (PosePair& pair : poses) {
    Pose& hand = pair.room_from_hand;
    hand.linear() = hand.linear() * exp_so3(noise.hand_rotation_rad * normal3(generator));
    hand.translation() += noise.hand_translation_mm * normal3(generator);
    Pose error = Pose::Identity();
    error.linear() = exp_so3(noise.eye_rotation_rad * normal3(generator));
    error.translation() = scale_units_per_mm * noise.eye_translation_mm * normal3(generator);
    pair.eye_from_scene = error * pair.eye_from_scene;
  }
}

std::vector<PosePair> every(std::size_t step, const std::vector<PosePair>& poses) {
  std::vector<PosePair> kept;
  for (std::size_t k = 0; k < poses.size(); k += step) kept.push_back(poses[k]);
  return kept;
}

std::vector<std::size_t> some_of(std::size_t n, std::size_t count, bool one_stretch,
                                 std::mt19937& generator) {
  std::vector<std::size_t> which(n);
  std::iota(which.begin(), which.end(), std::size_t{0});
  if (one_stretch) {
    const auto first = static_cast<std::ptrdiff_t>(generator() % (n - count + 1));
    std::rotate(which.begin(), which.begin() + first, which.end());
  } else {
    std::shuffle(which.begin(), which.end(), generator);
  }
  which.resize(count);
  std::sort(which.begin(), which.end());
  return which;
}

std::vector<PosePair> spoiled(std::vector<PosePair> poses, const std::vector<std::size_t>& which,
                              Spoiling spoiling, double scale_units_per_mm,
                              std::mt19937& generator) {
  const Pose same = make_pose(Eigen::Quaterniond(exp_so3({0.5, -0.3, 0.9})), {40, -20, 30});
  for (const std::size_t k : which) {
    spoil(poses[k], spoiling, scale_units_per_mm, same, generator);
  }
  return poses;
}

std::vector<PosePair> without(const std::vector<PosePair>& poses,
                              const std::vector<std::size_t>& which) {
  std::vector<PosePair> rest;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!std::binary_search(which.begin(), which.end(), k)) rest.push_back(poses[k]);
  }
  return rest;
}

}  // namespace handeye::synthetic
