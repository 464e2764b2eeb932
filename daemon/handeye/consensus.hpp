// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/handeye/screw.hpp"
#include "daemon/handeye/types.hpp"

namespace handeye {

struct ConsensusOptions {
  ScaleMode scale{ScaleMode::kUnknown};
  std::size_t partners{40};      ///< that each pose is compared with, spread over the sequence
  double min_angle_deg{1};       ///< movements that turn less do not vote
  double tolerance{4};           ///< sigma, estimated from the data, within which a movement agrees
  double certainly_right{0.4};   ///< share of the movements, for the first estimate
  double right_from_share{0.5};  ///< a pose is right when so large a share of its movements agree
  double pose_tolerance{5};      ///< sigma, as estimated, within which a solution explains a pose
  int rounds{3};                 ///< of estimating the noise and deciding
};

struct Consensus {
  std::vector<std::size_t> wrong;  ///< indices of the poses, ascending
  ScrewAgreement agreement;        ///< among the others
};

/// Which poses are grossly wrong. First, whatever X and room_from_scene are, those most of whose
/// movements to other poses (those that are right) hand and eye see differently: up to 20 % wrong
/// poses leave a right pose four fifths of its movements, a wrong one hardly any, at worst those to
/// poses that are wrong in the same way. Then those that a solution from the others does not
/// explain (explained.hpp). The cost is linear in the number of poses but for sorting them; their
/// order does not matter. Poses that are not usable (usable.hpp) are wrong; where fewer than four
/// are left, or fewer than half would be right, no other is.
Consensus find_consensus(std::span<const PosePair> poses, const ConsensusOptions& options = {});

/// The wrong poses alone.
std::vector<std::size_t> wrong_poses(std::span<const PosePair> poses,
                                     const ConsensusOptions& options = {});

}  // namespace handeye
