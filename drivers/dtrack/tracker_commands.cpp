// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/tracker_commands.hpp"

#include <utility>

#include <fmt/format.h>

namespace handeye::dtrack {
namespace {

CommandOutcome outcome_of(AnswerKind kind) {
  switch (kind) {
    case AnswerKind::kOk:
    case AnswerKind::kValue:
      return CommandOutcome::kDone;
    case AnswerKind::kError:
      return CommandOutcome::kRefused;
    case AnswerKind::kUnreachable:
      return CommandOutcome::kUnreachable;
    case AnswerKind::kTimedOut:
      return CommandOutcome::kTimedOut;
    case AnswerKind::kMalformed:
      return CommandOutcome::kMalformed;
    case AnswerKind::kInterrupted:
      return CommandOutcome::kInterrupted;
  }
  return CommandOutcome::kMalformed;
}

std::optional<Activity> activity_from(std::string_view word) {
  if (word == "none") return Activity::kNone;
  if (word == "mea") return Activity::kMeasuring;
  if (word == "cal") return Activity::kCalibrating;
  if (word == "wait") return Activity::kWaiting;
  if (word == "err") return Activity::kError;
  return std::nullopt;
}

/// One connection to the controller, and what it has said so far. A step that fails fills `report`
/// and returns false.
class Conversation {
 public:
  Conversation(const CommandOptions& options, const std::stop_token& stop)
      : channel_(options, stop) {}

  /// Who has the control. A controller that does not know the question has nobody to refuse.
  bool find_access();
  bool find_activity();
  /// Of `dtrack2 tracking start` and its like.
  bool command(std::string_view words);
  bool needs_control();

  CommandReport end(CommandOutcome outcome, std::string text) {
    report.outcome = outcome;
    report.text = std::move(text);
    return report;
  }

  CommandReport report;

 private:
  /// The value of `CATEGORY NAME`; nothing: refused or failed, as report says.
  std::optional<std::string> get(std::string_view category, std::string_view name);
  bool fail(const CommandAnswer& answer);
  bool fail(CommandOutcome outcome, std::string text) {
    end(outcome, std::move(text));
    return false;
  }

  CommandChannel channel_;
};

bool Conversation::fail(const CommandAnswer& answer) {
  std::string text = answer.text;
  if (answer.kind == AnswerKind::kError) {
    report.error_code = answer.error_code;
    text =
        fmt::format("the controller refuses: {} (error {})",
                    answer.text.empty() ? "it does not say why" : answer.text, answer.error_code);
  }
  return fail(outcome_of(answer.kind), std::move(text));
}

std::optional<std::string> Conversation::get(std::string_view category, std::string_view name) {
  const CommandAnswer answer = channel_.ask(fmt::format("dtrack2 get {} {}", category, name));
  if (answer.kind == AnswerKind::kValue && answer.category == category && answer.name == name) {
    return answer.value;
  }
  if (answer.kind == AnswerKind::kValue) {
    fail(CommandOutcome::kMalformed,
         fmt::format("asked for '{} {}', the controller answered for '{} {}'", category, name,
                     excerpt(answer.category), excerpt(answer.name)));
  } else if (answer.kind == AnswerKind::kOk) {
    fail(CommandOutcome::kMalformed,
         fmt::format("asked for '{} {}', the controller answered without a value", category, name));
  } else {
    fail(answer);
  }
  return std::nullopt;
}

bool Conversation::find_access() {
  const auto access = get("system", "access");
  if (!access) {
    if (report.outcome != CommandOutcome::kRefused) return false;
    report.error_code.reset();
    return true;
  }
  if (*access != "full" && *access != "none") {
    return fail(CommandOutcome::kMalformed,
                fmt::format("the controller gives '{}' as access", excerpt(*access)));
  }
  report.state.full_access = *access == "full";
  if (*report.state.full_access) return true;
  // Only to help: the answer is complete without.
  if (auto owner = get("system", "accessed_by")) {
    report.state.accessed_by = std::move(*owner);
  } else if (report.outcome == CommandOutcome::kRefused) {
    report.error_code.reset();
  } else {
    return false;
  }
  return true;
}

bool Conversation::needs_control() {
  if (report.state.full_access.value_or(true)) return true;
  const std::string& owner = report.state.accessed_by;
  return fail(CommandOutcome::kRefused,
              fmt::format("{} has the control of the tracker: disconnect it there, then try again",
                          owner.empty() ? "another program" : owner));
}

bool Conversation::find_activity() {
  const auto word = get("status", "active");
  if (!word) return false;
  report.state.activity = activity_from(*word);
  if (report.state.activity) return true;
  return fail(CommandOutcome::kMalformed,
              fmt::format("the controller gives '{}' as its status", excerpt(*word)));
}

bool Conversation::command(std::string_view words) {
  const CommandAnswer answer = channel_.ask(words);
  if (answer.kind == AnswerKind::kOk) return true;
  if (answer.kind == AnswerKind::kValue) {
    return fail(CommandOutcome::kMalformed, fmt::format("'{}' was answered with a value", words));
  }
  return fail(answer);
}

constexpr std::string_view kCalibrating =
    "an operator is calibrating the tracker: let that end first";

}  // namespace

std::string_view activity_text(Activity activity) {
  switch (activity) {
    case Activity::kNone:
      return "not tracking";
    case Activity::kMeasuring:
      return "tracking";
    case Activity::kCalibrating:
      return "being calibrated";
    case Activity::kWaiting:
      return "waiting for its cameras";
    case Activity::kError:
      return "in error";
  }
  return "";
}

CommandReport query_tracker(const CommandOptions& options, const std::stop_token& stop) {
  Conversation talk(options, stop);
  if (!talk.find_access()) return talk.report;
  if (!talk.report.state.full_access.value_or(true)) {
    const std::string& owner = talk.report.state.accessed_by;
    return talk.end(CommandOutcome::kDone,
                    fmt::format("{} has the control, so the controller does not say more",
                                owner.empty() ? "another program" : owner));
  }
  if (!talk.find_activity()) return talk.report;
  return talk.end(CommandOutcome::kDone,
                  fmt::format("the tracker is {}", activity_text(*talk.report.state.activity)));
}

CommandReport start_tracking(const CommandOptions& options, const std::stop_token& stop) {
  Conversation talk(options, stop);
  if (!talk.find_access() || !talk.needs_control() || !talk.find_activity()) return talk.report;
  switch (*talk.report.state.activity) {
    case Activity::kMeasuring:
    case Activity::kWaiting:
      return talk.end(CommandOutcome::kAlready, "tracking was on already");
    case Activity::kCalibrating:
      return talk.end(CommandOutcome::kRefused, std::string(kCalibrating));
    case Activity::kNone:
    case Activity::kError:
      break;
  }
  if (!talk.command("dtrack2 tracking start")) return talk.report;
  // It said ok, but only its status tells whether the cameras went along.
  if (!talk.find_activity()) {
    return talk.end(CommandOutcome::kDone,
                    fmt::format("tracking was started; then: {}", talk.report.text));
  }
  if (talk.report.state.activity == Activity::kError) {
    return talk.end(CommandOutcome::kRefused,
                    "tracking was started, but the controller reports an error: see its screen");
  }
  return talk.end(CommandOutcome::kDone, "tracking was started");
}

CommandReport stop_tracking(const CommandOptions& options, const std::stop_token& stop) {
  Conversation talk(options, stop);
  if (!talk.find_access() || !talk.needs_control() || !talk.find_activity()) return talk.report;
  if (talk.report.state.activity == Activity::kNone) {
    return talk.end(CommandOutcome::kAlready, "tracking was off already");
  }
  if (talk.report.state.activity == Activity::kCalibrating) {
    return talk.end(CommandOutcome::kRefused, std::string(kCalibrating));
  }
  if (!talk.command("dtrack2 tracking stop")) return talk.report;
  talk.report.state.activity = Activity::kNone;
  return talk.end(CommandOutcome::kDone, "tracking was stopped");
}

}  // namespace handeye::dtrack
