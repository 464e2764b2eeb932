// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "daemon/geometry/pose.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// The eye at one frame, as reconstructed.
struct EyeSample {
  std::int64_t timestamp_ns{0};           ///< camera stamp
  Pose eye_from_scene{Pose::Identity()};  ///< translation in scene units
  int part{0};  ///< samples of one part share a scene; a turn is between samples of the same
};

struct TimeOffsetOptions {
  double search_s{0.5};  ///< offsets of -search_s..+search_s are tried
  double grid_s{0.005};
  double interval_s{0.2};      ///< shortest time over which a speed is taken; evens out noise
  double max_interval_s{0.5};  ///< longer pauses of the camera are left out
  double min_angular_speed_rad_s{0.05};  ///< rms; below it there is nothing to correlate
  double min_peak{0.7};                  ///< agreement at the peak, 1: the speeds are equal
  double ambiguity{0.98};                ///< second peak / first peak at or above it: ambiguous
};

struct TimeOffset {
  double time_offset_s{0};  ///< add to a tracker time stamp to get the camera's of the same instant
  double sigma_s{0};
  double peak{0};         ///< agreement there: 1 - mean((e - h)^2) / (2 var(e)) of the speeds
  double second_peak{0};  ///< of the next local maximum; near `peak`: periodic motion
  /// 0..1: how sure it is that the offset lies in this peak, and that the peak tells where. The
  /// product of how far the peak rises above any agreement elsewhere, measured by how well it
  /// agrees itself, and of how narrow its error is against an interval of the speeds. Above 0.5:
  /// sure; below 0.1: move in another rhythm, or longer.
  double confidence{0};
};

/// Time offset by correlating the magnitudes of the angular velocities of hand and eye, which are
/// the same whatever hand_from_eye is (docs/math.md section 9); sub-sample peak. Both speeds are
/// taken over the same intervals, the hand's shifted, so that smoothing favours neither side.
/// Nothing when the rotation is too small, the peak too low, ambiguous or at the end of the search.
///
/// Example: the tracker's stamps read 20 ms less than the camera's for the same instant, so a
/// camera stamp t belongs to the hand pose stamped t - 0.020 s: time_offset_s is +0.020.
std::optional<TimeOffset> correlate_angular_speed(const PoseBuffer& hand,
                                                  std::span<const EyeSample> eye,
                                                  const TimeOffsetOptions& options = {});

}  // namespace handeye
