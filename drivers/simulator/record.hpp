// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// What was sent or written.
struct DeviceCounts {
  std::uint64_t frames{0};
  std::uint64_t frames_skipped{0};  ///< rendering could not keep up; the frame number shows the gap
  std::uint64_t datagrams{0};
};

/// truth.json in a folder, OUT.truth.json beside OUT.lcm.
std::filesystem::path truth_path_of(const std::filesystem::path& recording);

/// Writes `duration_s` of both devices to a new recording, in order of arrival, as fast as it goes;
/// camera.json and truth.json lie with it. The same world gives the same bytes. Throws InputError
/// when the recording exists or cannot be written.
DeviceCounts record(const World& world, double duration_s, const std::filesystem::path& path);

}  // namespace handeye::simulator
