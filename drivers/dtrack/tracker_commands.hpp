// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "drivers/dtrack/command_channel.hpp"

namespace handeye::dtrack {

/// What the controller is at (`status active`).
enum class Activity {
  kNone,         ///< none: not tracking
  kMeasuring,    ///< mea
  kCalibrating,  ///< cal: of room or body, by an operator
  kWaiting,      ///< wait: for its cameras or its synchronisation
  kError,        ///< err
};

/// In words: "not tracking", "tracking", ...
std::string_view activity_text(Activity activity);

/// What is known of the controller after it was talked to.
struct TrackerState {
  std::optional<Activity> activity;  ///< nothing: it did not say
  std::optional<bool> full_access;   ///< false: another program was connected first
  std::string accessed_by;           ///< which; as the controller names it, may be empty
};

enum class CommandOutcome {
  kDone,         ///< as asked
  kAlready,      ///< it was so before; nothing was changed
  kRefused,      ///< the controller does not, or must not be asked to; the text says why
  kUnreachable,  ///< no connection, or none that lasts
  kTimedOut,     ///< connected, but the answer did not come in time
  kMalformed,    ///< whoever answers there is no DTrack
  kInterrupted,  ///< the caller was told to stop
};

struct CommandReport {
  CommandOutcome outcome{CommandOutcome::kMalformed};
  TrackerState state;
  std::optional<int> error_code;  ///< of the controller's error answer
  std::string text;               ///< one line for a person, without address; printable ASCII
};

// Each connects, acts, and lets go, all within options.timeout. Each asks first whether it has the
// control, and what the tracker is at: tracking that runs is not started again, a calibration in
// progress is not disturbed, and who was connected before us is named. Throw UsageError when
// options.controller is no address.

CommandReport start_tracking(const CommandOptions& options, const std::stop_token& stop = {});
CommandReport stop_tracking(const CommandOptions& options, const std::stop_token& stop = {});
/// kDone even where another program has the control, and the activity therefore stays unknown.
CommandReport query_tracker(const CommandOptions& options, const std::stop_token& stop = {});

}  // namespace handeye::dtrack
