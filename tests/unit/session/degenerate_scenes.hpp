// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/simulator/world.hpp"
#include "tests/unit/session/trial.hpp"

/// Scenes and motions that do not suffice, or hardly: from rendered images to the verdict.
namespace handeye::degenerate {

/// Its reasons are why it is to be refused: any of these; none: an answer may be accepted, or
/// refused for whatever reason.
using Scene = trial::SceneOf<simulator::SimulatorOptions>;

std::span<const Scene> scenes();
/// Throws std::out_of_range for an unknown name.
const Scene& scene(std::string_view name);

using trial::describe;
using trial::Trial;

/// Renders the scene of this seed, 640x480 at 25 Hz, into a temporary recording, and replays it.
Trial run(const Scene& scene, std::uint64_t seed, double duration_s);

/// Within 3.5 of its own sigmas where it was accepted; refused for a reason that is right where
/// there are reasons.
bool is_right(const Scene& scene, const Trial& trial);

}  // namespace handeye::degenerate
