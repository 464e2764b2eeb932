// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include <handeye/request_t.hpp>
#include <handeye/status_t.hpp>

#include "daemon/service/pose_publisher.hpp"
#include "daemon/session/calibration_watch.hpp"
#include "daemon/session/progress.hpp"
#include "daemon/session/session.hpp"
#include "daemon/tracking/image_condition.hpp"

namespace handeye {

/// The request as it came over LCM. Nothing when version, action or id are not ours; `problem` then
/// says why.
std::optional<Request> read_request(const request_t& message, std::string& problem);

/// Writes the session's part of STATUS: state, request, acknowledgements.
void write_session(const Session& session, status_t& status);

/// What a running calibration ends at, and where it is.
struct ProgressTerms {
  WantedSigma wanted;
  double min_duration_s{8};
  double max_duration_s{30};
  double elapsed_s{0};
};

/// Writes the running calibration's part: progress towards the wanted sigma or the time limit, the
/// answer as it stands, what to do next.
void write_progress(const CalibrationProgress& progress, const ProgressTerms& terms,
                    status_t& status);

/// Writes that none is running: nothing is known.
void write_no_progress(status_t& status);

/// Writes which calibration is in use, and how old it is.
void write_calibration(const std::optional<ActiveCalibration>& calibration, std::int64_t now_ns,
                       status_t& status);

/// Writes whether the calibration in use still holds.
void write_watch(const WatchStatus& watch, status_t& status);

/// One of status_t's WATCH constants.
std::int32_t watch_code(WatchState state);

/// What ails the camera's picture, in words: "the picture is dark". Empty for kGood.
std::string_view picture_text(ImageCondition condition);

}  // namespace handeye
