// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/simulator/world.hpp"

namespace handeye::sequences {

/// How a named sequence is to be drawn; the name says what makes it hard.
struct SequenceOptions {
  std::uint64_t seed{1};
  double duration_s{8.0};
  double camera_rate_hz{25.0};
  int width{640};
  int height{480};
};

/// The eight that reconstruction must master: plain, flicker, highlights, round_mask, distortion,
/// blur, noise, missing_frames.
std::span<const std::string_view> must_have_names();

/// Those that may be refused, but never answered wrongly: plane, rotation, bare, instrument,
/// interlaced, frozen, dark.
std::span<const std::string_view> hard_names();

/// What the simulator is told for a sequence. Throws UsageError for an unknown name.
simulator::SimulatorOptions simulator_options(std::string_view name,
                                              const SequenceOptions& options);

}  // namespace handeye::sequences
