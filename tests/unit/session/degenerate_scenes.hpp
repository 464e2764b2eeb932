// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/session/result.hpp"
#include "drivers/simulator/world.hpp"

/// Scenes and motions that do not suffice, or hardly: from rendered images to the verdict.
namespace handeye::degenerate {

struct Scene {
  std::string_view name;
  void (*apply)(simulator::SimulatorOptions& options);
  /// Why it is to be refused: any of these; none: an answer may be accepted, or refused for
  /// whatever reason.
  std::vector<Reason> reasons;
};

std::span<const Scene> scenes();
/// Throws std::out_of_range for an unknown name.
const Scene& scene(std::string_view name);

/// What a replay said, against the truth.
struct Trial {
  CalibrationResult result;
  double rotation_error_deg{0};
  double translation_error_mm{0};

  bool accepted() const { return result.verdict == Verdict::kAccepted; }
  /// Of both errors the larger, in the sigma that was claimed for it.
  double error_in_sigmas() const;
};

/// Renders the scene of this seed, 640x480 at 25 Hz, into a temporary recording, and replays it.
Trial run(const Scene& scene, std::uint64_t seed, double duration_s);

/// Within 3.5 of its own sigmas where it was accepted; refused for a reason that is right where
/// there are reasons.
bool is_right(const Scene& scene, const Trial& trial);

/// One line: verdict, reason, error and sigma.
std::string describe(const Trial& trial);

}  // namespace handeye::degenerate
