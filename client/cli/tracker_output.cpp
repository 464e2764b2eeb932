// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/tracker_output.hpp"

#include <fmt/format.h>

namespace handeye::cli {
namespace {

using dtrack::Activity;
using dtrack::CommandOutcome;
using Json = nlohmann::ordered_json;

std::string_view activity_word(Activity activity) {
  switch (activity) {
    case Activity::kNone:
      return "none";
    case Activity::kMeasuring:
      return "measuring";
    case Activity::kCalibrating:
      return "calibrating";
    case Activity::kWaiting:
      return "waiting";
    case Activity::kError:
      return "error";
  }
  return "";
}

std::string colored_activity(const std::optional<Activity>& activity, const Palette& palette) {
  if (!activity) return palette.yellow("not known");
  const std::string_view text = dtrack::activity_text(*activity);
  if (*activity == Activity::kMeasuring) return palette.green(text);
  return *activity == Activity::kError ? palette.red(text) : palette.yellow(text);
}

std::string control_text(const dtrack::TrackerState& state) {
  if (!state.full_access) return "the controller does not tell";
  if (*state.full_access) return "free";
  return state.accessed_by.empty() ? "another program has it"
                                   : fmt::format("{} has it", state.accessed_by);
}

/// What is likeliest wrong where nobody, or somebody else, answers.
std::string_view advice(CommandOutcome outcome) {
  switch (outcome) {
    case CommandOutcome::kUnreachable:
      return ": is the controller on, and this its address?";
    case CommandOutcome::kMalformed:
      return ": is this DTrack's port for commands?";
    case CommandOutcome::kTimedOut:
      return ": the controller may be busy; try again, or allow more with --timeout";
    default:
      return "";
  }
}

}  // namespace

ExitCode tracker_exit_code(CommandOutcome outcome) {
  switch (outcome) {
    case CommandOutcome::kDone:
    case CommandOutcome::kAlready:
      return ExitCode::kOk;
    case CommandOutcome::kRefused:
      return ExitCode::kRefused;
    case CommandOutcome::kTimedOut:
      return ExitCode::kTimedOut;
    case CommandOutcome::kUnreachable:
    case CommandOutcome::kMalformed:
    case CommandOutcome::kInterrupted:
      break;
  }
  return ExitCode::kInput;
}

std::string_view tracker_outcome_word(CommandOutcome outcome) {
  switch (outcome) {
    case CommandOutcome::kDone:
      return "done";
    case CommandOutcome::kAlready:
      return "already";
    case CommandOutcome::kRefused:
      return "refused";
    case CommandOutcome::kUnreachable:
      return "unreachable";
    case CommandOutcome::kTimedOut:
      return "timed_out";
    case CommandOutcome::kMalformed:
      return "malformed";
    case CommandOutcome::kInterrupted:
      return "interrupted";
  }
  return "";
}

Json tracker_json(const TrackerAnswer& answer) {
  const dtrack::CommandReport& report = answer.report;
  const dtrack::TrackerState& state = report.state;
  Json json{{"action", answer.action}, {"controller", answer.controller},
            {"port", answer.port},     {"outcome", tracker_outcome_word(report.outcome)},
            {"activity", nullptr},     {"access", nullptr},
            {"accessed_by", nullptr},  {"error_code", nullptr},
            {"text", report.text}};
  if (state.activity) json["activity"] = activity_word(*state.activity);
  if (state.full_access) json["access"] = *state.full_access ? "full" : "none";
  if (!state.accessed_by.empty()) json["accessed_by"] = state.accessed_by;
  if (report.error_code) json["error_code"] = *report.error_code;
  return json;
}

std::string tracker_text(const TrackerAnswer& answer, const Palette& palette) {
  const dtrack::CommandReport& report = answer.report;
  if (answer.action != "status") return palette.green(report.text) + "\n";
  return fmt::format("controller      {}:{}\ntracker         {}\ncontrol         {}\n",
                     answer.controller, answer.port,
                     colored_activity(report.state.activity, palette), control_text(report.state));
}

std::string tracker_failure(const TrackerAnswer& answer) {
  return fmt::format("controller {}:{}: {}{}", answer.controller, answer.port, answer.report.text,
                     advice(answer.report.outcome));
}

}  // namespace handeye::cli
