// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"

namespace handeye {

/// The poses that share one scene and one scale.
struct Part {
  int number{0};                     ///< HandEyeObservation::part
  std::vector<std::size_t> members;  ///< indices of observations, ascending; never empty
};

/// Beside the largest part, one of fewer poses hardly says more than its own scene and scale take
/// (seven unknowns); it does not count.
inline constexpr std::size_t kFewestPosesOfPart = 5;

/// The parts that observations are of, the largest first; of equal ones the lower number.
std::vector<Part> parts_of(std::span<const HandEyeObservation> observations);

/// The poses of one part, for what knows but one scene.
std::vector<PosePair> poses_of(std::span<const HandEyeObservation> observations, const Part& part);

}  // namespace handeye
