// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Finite, and its matrix a rotation but for rounding in a text file.
bool is_usable(const Pose& pose);

/// Both of every pair.
bool are_usable(std::span<const PosePair> poses);

}  // namespace handeye
