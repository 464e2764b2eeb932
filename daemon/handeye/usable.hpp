// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Finite, and its matrix a rotation but for rounding in a text file: of poses, and of movements
/// between them.
bool is_usable(const Pose& pose);

/// Its pose usable, its scale positive.
bool is_usable(const HandEyeSolution& solution);

/// Both of every pair.
bool are_usable(std::span<const PosePair> poses);

}  // namespace handeye
