// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "drivers/recording/recording.hpp"

namespace handeye {

/// Reads tracker.txt: per datagram a line `@ <arrival_ns> <byte count>`, then exactly that many raw
/// bytes, then a newline. Throws InputError when it is cut short, damaged, or goes back in time.
std::vector<RecordedDatagram> read_tracker_file(const std::filesystem::path& path);

}  // namespace handeye
