// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "daemon/handeye/maximum_likelihood.hpp"
#include "drivers/simulator/world.hpp"

namespace handeye {

/// What the best possible pictures leave of a recorded sequence's error: the likelihood's answer to
/// the true poses of the eye, scale and time offset free, and all samples of the tracker. No
/// program that gets pictures and these samples can be expected to do better.
std::optional<MaximumLikelihoodResult> answer_of_perfect_camera(
    const simulator::World& world, const std::filesystem::path& recording);

}  // namespace handeye
