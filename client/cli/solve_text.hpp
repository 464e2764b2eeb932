// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "client/cli/terminal.hpp"
#include "daemon/session/pose_solve.hpp"

namespace handeye::cli {

/// What the methods make of poses, for a person: verdict and estimate of maximum_likelihood, the
/// methods side by side in the paper's columns, and where each puts the camera. Several lines, the
/// last with its newline. A refused estimate is marked as such.
std::string solve_text(const PoseSolution& solution, const Palette& palette);

}  // namespace handeye::cli
