// SPDX-License-Identifier: BSD-3-Clause
// What start, stop and status make of a controller's answers.
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/dtrack/tracker_commands.hpp"
#include "protocol/exit_codes.hpp"
#include "tests/unit/dtrack/scripted_controller.hpp"

namespace handeye::dtrack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kAccess = "dtrack2 get system access";
constexpr const char* kOwner = "dtrack2 get system accessed_by";
constexpr const char* kActive = "dtrack2 get status active";
constexpr const char* kStart = "dtrack2 tracking start";
constexpr const char* kStop = "dtrack2 tracking stop";

/// Answers each command with the next of its answers, the last again and again.
class Dialogue {
 public:
  explicit Dialogue(std::map<std::string, std::vector<std::string>> answers)
      : answers_(std::move(answers)), controller_([this](Peer& peer) { serve(peer); }) {}

  CommandOptions options() const {
    return {.controller = "127.0.0.1",
            .port = controller_.port(),
            .connect_timeout = std::chrono::seconds(30),
            .timeout = std::chrono::seconds(30)};
  }
  std::vector<std::string> heard() const {
    const std::scoped_lock lock(mutex_);
    return heard_;
  }

 private:
  void serve(Peer& peer) {
    while (const auto command = peer.command()) {
      const std::scoped_lock lock(mutex_);
      heard_.push_back(*command);
      auto& answers = answers_[*command];
      if (answers.empty()) answers.emplace_back(R"(dtrack2 err 1 "unknown command")");
      peer.answer(answers.front());
      if (answers.size() > 1) answers.erase(answers.begin());
    }
  }

  mutable std::mutex mutex_;
  std::vector<std::string> heard_;
  std::map<std::string, std::vector<std::string>> answers_;
  ScriptedController controller_;
};

const std::vector<std::string> kFull{"dtrack2 set system access full"};
const std::vector<std::string> kNoAccess{"dtrack2 set system access none"};

std::string active(const std::string& word) {
  return "dtrack2 set status active " + word;
}

TEST(TrackerCommands, StartsWhatIsOff) {
  const Dialogue dialogue(
      {{kAccess, kFull}, {kActive, {active("none"), active("mea")}}, {kStart, {"dtrack2 ok"}}});
  const CommandReport report = start_tracking(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kDone) << report.text;
  EXPECT_EQ(report.state.activity, Activity::kMeasuring);
  EXPECT_EQ(report.state.full_access, true);
  EXPECT_EQ(report.text, "tracking was started");
  EXPECT_THAT(dialogue.heard(), ElementsAre(kAccess, kActive, kStart, kActive));
}

TEST(TrackerCommands, DoesNotStartWhatRuns) {
  for (const char* const word : {"mea", "wait"}) {
    const Dialogue dialogue({{kAccess, kFull}, {kActive, {active(word)}}});
    const CommandReport report = start_tracking(dialogue.options());
    EXPECT_EQ(report.outcome, CommandOutcome::kAlready) << report.text;
    EXPECT_THAT(dialogue.heard(), ElementsAre(kAccess, kActive)) << word;
  }
}

TEST(TrackerCommands, StopsWhatRuns) {
  const Dialogue dialogue({{kAccess, kFull}, {kActive, {active("mea")}}, {kStop, {"dtrack2 ok"}}});
  const CommandReport report = stop_tracking(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kDone) << report.text;
  EXPECT_EQ(report.state.activity, Activity::kNone);
  EXPECT_THAT(dialogue.heard(), ElementsAre(kAccess, kActive, kStop));
}

TEST(TrackerCommands, DoesNotStopWhatIsOff) {
  const Dialogue dialogue({{kAccess, kFull}, {kActive, {active("none")}}});
  EXPECT_EQ(stop_tracking(dialogue.options()).outcome, CommandOutcome::kAlready);
  EXPECT_THAT(dialogue.heard(), ElementsAre(kAccess, kActive));
}

TEST(TrackerCommands, NeverDisturbsACalibration) {
  for (const auto command : {start_tracking, stop_tracking}) {
    const Dialogue dialogue({{kAccess, kFull},
                             {kActive, {active("cal")}},
                             {kStart, {"dtrack2 ok"}},
                             {kStop, {"dtrack2 ok"}}});
    const CommandReport report = command(dialogue.options(), {});
    EXPECT_EQ(report.outcome, CommandOutcome::kRefused);
    EXPECT_EQ(report.state.activity, Activity::kCalibrating);
    EXPECT_THAT(report.text, HasSubstr("calibrating"));
    EXPECT_THAT(dialogue.heard(), ElementsAre(kAccess, kActive));
  }
}

TEST(TrackerCommands, NamesWhoHasTheControl) {
  for (const auto command : {start_tracking, stop_tracking}) {
    const Dialogue dialogue({{kAccess, kNoAccess},
                             {kOwner, {"dtrack2 set system accessed_by 10.0.0.7"}},
                             {kActive, {active("none")}}});
    const CommandReport report = command(dialogue.options(), {});
    EXPECT_EQ(report.outcome, CommandOutcome::kRefused);
    EXPECT_EQ(report.state.full_access, false);
    EXPECT_EQ(report.state.accessed_by, "10.0.0.7");
    EXPECT_THAT(report.text, HasSubstr("10.0.0.7 has the control"));
    EXPECT_FALSE(report.error_code.has_value());
    EXPECT_THAT(dialogue.heard(), ElementsAre(kAccess, kOwner));
  }
}

TEST(TrackerCommands, BearsThatTheOwnerStaysUnknown) {
  const Dialogue dialogue({{kAccess, kNoAccess}});
  const CommandReport report = start_tracking(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kRefused);
  EXPECT_THAT(report.text, HasSubstr("another program has the control"));
  EXPECT_FALSE(report.error_code.has_value());
}

TEST(TrackerCommands, TellsEveryStatus) {
  const std::map<std::string, Activity> words{{"none", Activity::kNone},
                                              {"mea", Activity::kMeasuring},
                                              {"cal", Activity::kCalibrating},
                                              {"wait", Activity::kWaiting},
                                              {"err", Activity::kError}};
  for (const auto& [word, activity] : words) {
    const Dialogue dialogue({{kAccess, kFull}, {kActive, {active(word)}}});
    const CommandReport report = query_tracker(dialogue.options());
    EXPECT_EQ(report.outcome, CommandOutcome::kDone) << report.text;
    EXPECT_EQ(report.state.activity, activity);
    EXPECT_THAT(report.text, HasSubstr(std::string(activity_text(activity))));
  }
}

TEST(TrackerCommands, AsksNoStatusWhereAnotherHasTheControl) {
  const Dialogue dialogue(
      {{kAccess, kNoAccess}, {kOwner, {"dtrack2 set system accessed_by 10.0.0.7"}}});
  const CommandReport report = query_tracker(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kDone);
  EXPECT_FALSE(report.state.activity.has_value());
  EXPECT_THAT(report.text, HasSubstr("10.0.0.7"));
}

TEST(TrackerCommands, AControllerThatKnowsNoAccessIsSimplyAsked) {
  const Dialogue dialogue({{kActive, {active("none"), active("mea")}}, {kStart, {"dtrack2 ok"}}});
  const CommandReport report = start_tracking(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kDone) << report.text;
  EXPECT_FALSE(report.state.full_access.has_value());
  EXPECT_FALSE(report.error_code.has_value());
}

TEST(TrackerCommands, PassesOnWhyTheControllerRefuses) {
  const Dialogue dialogue({{kAccess, kFull},
                           {kActive, {active("none")}},
                           {kStart, {R"(dtrack2 err 42 "no cameras found")"}}});
  const CommandReport report = start_tracking(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kRefused);
  EXPECT_EQ(report.error_code, 42);
  EXPECT_EQ(report.text, "the controller refuses: no cameras found (error 42)");

  const Dialogue silent({{kAccess, kFull}, {kActive, {R"(dtrack2 err 7 "")"}}});
  EXPECT_THAT(query_tracker(silent.options()).text, HasSubstr("it does not say why (error 7)"));
}

TEST(TrackerCommands, LooksWhetherTheCamerasWentAlong) {
  const Dialogue dialogue(
      {{kAccess, kFull}, {kActive, {active("none"), active("err")}}, {kStart, {"dtrack2 ok"}}});
  const CommandReport report = start_tracking(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kRefused);
  EXPECT_EQ(report.state.activity, Activity::kError);
}

TEST(TrackerCommands, WhatWasStartedIsStartedEvenIfItsStatusStaysUnknown) {
  const Dialogue dialogue(
      {{kAccess, kFull}, {kActive, {active("none"), "nonsense"}}, {kStart, {"dtrack2 ok"}}});
  const CommandReport report = start_tracking(dialogue.options());
  EXPECT_EQ(report.outcome, CommandOutcome::kDone);
  EXPECT_THAT(report.text, HasSubstr("nonsense"));
}

TEST(TrackerCommands, RefusesAnswersThatDoNotFitTheQuestion) {
  const std::vector<std::map<std::string, std::vector<std::string>>> dialogues{
      {{kAccess, {"dtrack2 ok"}}},
      {{kAccess, {"dtrack2 set system access some"}}},
      {{kAccess, {"dtrack2 set system accessed_by full"}}},
      {{kAccess, kFull}, {kActive, {"dtrack2 ok"}}},
      {{kAccess, kFull}, {kActive, {active("dancing")}}},
      {{kAccess, kFull}, {kActive, {"dtrack2 set config active_config standard"}}},
      {{kAccess, kFull}, {kActive, {active("")}}},
      {{kAccess, kFull}, {kActive, {active("none")}}, {kStart, {active("mea")}}},
      {{kAccess, {"ok"}}}};
  for (const auto& answers : dialogues) {
    const Dialogue dialogue(answers);
    const CommandReport report = start_tracking(dialogue.options());
    EXPECT_EQ(report.outcome, CommandOutcome::kMalformed) << report.text;
    EXPECT_FALSE(report.text.empty());
  }
}

TEST(TrackerCommands, TellsWhoeverIsNotThere) {
  const ListeningPort deaf(std::nullopt);
  const CommandOptions nobody{.controller = "127.0.0.1", .port = deaf.port()};
  for (const auto command : {start_tracking, stop_tracking, query_tracker}) {
    const CommandReport report = command(nobody, {});
    EXPECT_EQ(report.outcome, CommandOutcome::kUnreachable);
    EXPECT_EQ(report.text, "Connection refused");
    EXPECT_THROW(command({.controller = "nowhere"}, {}), UsageError);
  }
}

}  // namespace
}  // namespace handeye::dtrack
