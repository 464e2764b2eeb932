// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/reconstruction/frame_record.hpp"
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

namespace handeye::test {

inline std::vector<FrameRecord> records_of(const SyntheticTracks& tracks) {
  std::vector<FrameRecord> records;
  for (const TrackedFrame& frame : tracks.frames) records.push_back(make_record(frame));
  return records;
}

/// The motion from another moment on for each seed, 30 frames of it.
inline SyntheticTracks stretch(const Motion& motion, SyntheticOptions options, unsigned seed) {
  options.seed = seed;
  options.frames = 30;
  return synthesize(options,
                    [&motion, seed](double time_s) { return motion(time_s + 0.37 * seed); });
}

}  // namespace handeye::test
