// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "daemon/sync/hand_prediction.hpp"

namespace handeye::hand_samples {

inline constexpr double kRate_hz = 60;
inline constexpr std::int64_t kMillisecond_ns = 1'000'000;
inline const HandSampleNoise kNoise{.rotation_rad = rad_from_deg(0.06), .translation_mm = 0.15};

inline std::int64_t ns(double time_s) {
  return static_cast<std::int64_t>(std::llround(1e9 * time_s));
}

inline HandSample sample(double time_s, const Pose& room_from_hand) {
  HandSample result;
  result.timestamp_ns = ns(time_s);
  result.tracked = true;
  result.room_from_hand = room_from_hand;
  return result;
}

}  // namespace handeye::hand_samples
