// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace handeye {

/// What is worth finding again in the journal: changes of state, never their repetition. Each kind
/// has a MESSAGE_ID of its own, for ever; docs/service.md lists them.
enum class Event {
  kReady,
  kDeviceThere,             ///< DEVICE
  kDeviceLost,              ///< DEVICE
  kCalibrationStarted,      ///< REQUEST_ID, BODY_ID
  kCalibrationAccepted,     ///< REQUEST_ID
  kCalibrationRefused,      ///< REQUEST_ID, REASON
  kCalibrationCancelled,    ///< REQUEST_ID
  kCalibrationRestored,     ///< REQUEST_ID, AGE_S
  kCalibrationNotRestored,  ///< FILE
  kCalibrationNotStored,    ///< FILE
  kWatchBroken,             ///< REQUEST_ID
  kWatchHolds,    ///< REQUEST_ID; again after it was broken, or the first time after a restart
  kThreadStuck,   ///< THREAD
  kThreadGoesOn,  ///< THREAD
};

struct EventField {
  std::string_view name;  ///< as the journal wants it: A-Z, 0-9, '_'
  std::string value;
};

/// Before the first line of log. Under systemd everything goes to the journal with its priority,
/// else to stderr. `level`: "debug", "info", "warning", "error".
void set_up_logging(const std::string& level);

/// Says it in the log, and with the fields where that is the journal.
void log_event(Event event, const std::string& text, std::initializer_list<EventField> fields = {});

/// "NAME=value" each, as the journal takes them.
std::vector<std::string> journal_entry(Event event, const std::string& text,
                                       std::initializer_list<EventField> fields);

/// Whether stderr is the journal's, and not, say, a file that a program under systemd writes to.
bool stderr_is_the_journal();

}  // namespace handeye
