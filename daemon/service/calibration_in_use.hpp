// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/config/config.hpp"
#include "daemon/service/pose_publisher.hpp"
#include "daemon/session/calibration_watch.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

// An accepted result, as those need it who use it from then on. Where it does not tell the hand's
// noise, the configuration does.

/// When it was found by CLOCK_MONOTONIC, below 0 if the machine was started since; `now_ns`: when
/// its age was that of the vintage. Nothing: not known.
std::optional<std::int64_t> solved_ns(const Vintage& vintage, std::int64_t now_ns);

/// For CAMERA_POSE, once it has a vintage. `now_ns`: CLOCK_MONOTONIC.
ActiveCalibration active_calibration(const CalibrationResult& result,
                                     const Config::Tracker& tracker, std::int64_t now_ns);

/// Why a calibration that was kept is none for this camera, as the configuration describes it: one
/// line. Nothing: it is.
std::optional<std::string> misfit(const CalibrationResult& result, const CameraModel& camera);

/// For the watch, which trusts neither hand nor features more than is plausible, whatever the
/// calibration found.
WatchedCalibration watched_calibration(const CalibrationResult& result,
                                       const Config::Tracker& tracker);

}  // namespace handeye
