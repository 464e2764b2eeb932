// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace handeye {

struct Cell {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};
  std::vector<std::size_t> members;  ///< indices of vectors; never empty
};

/// Vector quantisation by splitting (Linde, Buzo, Gray 1980) down a tree: again and again the cell
/// of the largest distortion is cut in two along its widest direction and the halves are settled by
/// 2-means. No random start: the same cells every time. At most `cells` cells, fewer where vectors
/// coincide. The cost is about the number of vectors times log(cells).
std::vector<Cell> quantise(std::span<const Eigen::Vector3d> vectors, std::size_t cells);

}  // namespace handeye
