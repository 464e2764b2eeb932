// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

struct SelectionOptions {
  ScaleMode scale{ScaleMode::kUnknown};
  std::size_t max_poses{200};        ///< longer sequences are thinned evenly
  std::size_t max_candidates{4000};  ///< movements that are looked at
  std::size_t max_movements{500};
  std::size_t enough{50};  ///< below so many the largest angle goes, then the smallest is halved
  double min_angle_deg{15};
  double lowest_min_angle_deg{1};  ///< smaller turns say nothing, however few there are
  double max_angle_deg{175};  ///< beyond it the axis is ambiguous; left out where enough others are
  double tolerance{4};        ///< sigma within which hand and eye must agree (consensus.hpp)
};

struct Selection {
  std::vector<Movement> movements;
  /// Between which poses each movement is: indices i, j into the poses selected from.
  std::vector<std::array<std::size_t, 2>> pairs;
  std::vector<std::size_t> wrong_poses;  ///< found among those looked at, and left out; ascending
};

/// Movements between pairs (i, j) of the whole sequence rather than neighbours, with large angles,
/// one of each cell of the rotation vectors' vector quantisation (Schmidt, Vogt, Niemann 2004). Of
/// a cell it is the one whose poses are used least and that is nearest to the cell's centre: pairs
/// of the same pose share its error. Wrong poses are left out, and movements that hand and eye see
/// differently. Deterministic, and of bounded cost but for the thinning.
Selection select_movements(std::span<const PosePair> poses, const SelectionOptions& options = {});

}  // namespace handeye
