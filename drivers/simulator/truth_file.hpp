// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// What a calibration ought to find, with the names of the result JSON (hand_from_eye,
/// time_offset_s, camera), and what else was drawn: seed, motion, clocks, delays, noise.
nlohmann::ordered_json truth_json(const World& world);

/// Throws InputError when the file cannot be written.
void write_truth(const std::filesystem::path& path, const World& world);

}  // namespace handeye::simulator
