// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/simulator/endoscope_device.hpp"
#include "drivers/simulator/world.hpp"
#include "tests/unit/session/trial.hpp"

/// What goes wrong with the time and the way of both devices' data, from images and datagrams to
/// the verdict: a calibration must come out right all the same, or be refused.
namespace handeye::timing {

struct Footage {
  explicit Footage(std::uint64_t seed, double duration_s = 12, int width = 320, int height = 240);
  Footage(const Footage&) = delete;
  Footage& operator=(const Footage&) = delete;

  simulator::World world;  ///< undisturbed
  double duration_s;
  std::vector<cv::Mat> pictures;  ///< of every frame; rendered once, for rendering is what costs
};

/// Disturbs the footage's world; the pictures stay. Too little may be left to answer: refused for
/// any of its reasons is right, too. None: it is to be accepted.
using Scene = trial::SceneOf<simulator::World>;

std::span<const Scene> scenes();
/// Throws std::out_of_range for an unknown name.
const Scene& scene(std::string_view name);

struct Trial : trial::Trial {
  double time_offset_error_s{0};
};

/// The daemon's pipeline on the footage, disturbed; datagrams and frames in order of arrival.
Trial run(const Scene& scene, const Footage& footage);

/// Accepted within 3.5 of its own sigmas, or refused for a reason that is right.
bool is_right(const Scene& scene, const Trial& trial);

/// One line: as of any trial, and the time offset.
std::string describe(const Trial& trial);

}  // namespace handeye::timing
