// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/unit/handeye/synthetic.hpp"

namespace handeye::synthetic {

/// One stretch of a recording as a reconstruction that started anew gives it.
struct PartTruth {
  std::size_t poses{0};
  double scale_units_per_mm{1};
  Pose room_from_scene{Pose::Identity()};  ///< scene in mm
};

struct PartedRecording {
  std::vector<HandEyeObservation> observations;
  std::vector<PartTruth> parts;  ///< by number
};

/// The observations in consecutive parts 0, 1, ... of these lengths (the rest is left off), each
/// seen from a scene of its own, placed at random, and of the given scale. `truth`: of the
/// observations.
PartedRecording in_parts(std::span<const HandEyeObservation> observations, const Truth& truth,
                         const std::vector<std::size_t>& lengths, const std::vector<double>& scales,
                         std::uint32_t seed);

/// Those of one part, for comparison.
std::vector<HandEyeObservation> only(std::span<const HandEyeObservation> observations, int part);

/// Turns the camera in its clip, in the poses of one part: they are right for another answer.
void slip(std::vector<HandEyeObservation>& observations, int part,
          const Eigen::Vector3d& rotation_rad);

}  // namespace handeye::synthetic
