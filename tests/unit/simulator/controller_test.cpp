// SPDX-License-Identifier: BSD-3-Clause
// The simulated controller, as the driver that will talk to a real one sees it.
#include "drivers/simulator/controller.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/dtrack/tracker_commands.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

using dtrack::Activity;
using dtrack::AnswerKind;
using dtrack::CommandOutcome;
using testing::HasSubstr;

constexpr std::chrono::milliseconds kPatient{30'000};

Controller controller_with(std::optional<ControllerFault> fault = std::nullopt) {
  return Controller({.port = 0, .fault = fault});
}

dtrack::CommandOptions options_for(const Controller& controller,
                                   std::chrono::milliseconds timeout = kPatient) {
  return {.controller = "127.0.0.1",
          .port = controller.port(),
          .connect_timeout = timeout,
          .timeout = timeout};
}

TEST(Controller, TracksFromStartToStop) {
  const Controller controller = controller_with();
  const auto options = options_for(controller);
  EXPECT_FALSE(controller.tracking());
  EXPECT_EQ(dtrack::query_tracker(options).state.activity, Activity::kNone);
  EXPECT_EQ(dtrack::stop_tracking(options).outcome, CommandOutcome::kAlready);

  EXPECT_EQ(dtrack::start_tracking(options).outcome, CommandOutcome::kDone);
  EXPECT_TRUE(controller.tracking());
  EXPECT_EQ(dtrack::query_tracker(options).state.activity, Activity::kMeasuring);
  EXPECT_EQ(dtrack::start_tracking(options).outcome, CommandOutcome::kAlready);

  EXPECT_EQ(dtrack::stop_tracking(options).outcome, CommandOutcome::kDone);
  EXPECT_FALSE(controller.tracking());
}

TEST(Controller, AnswersErrorsToWhatItDoesNotKnow) {
  const Controller controller = controller_with();
  dtrack::CommandChannel channel(options_for(controller));
  for (const char* const command :
       {"dtrack2 tracking pause", "dtrack2 get status mood", "dtrack2 ", "hello", ""}) {
    const dtrack::CommandAnswer answer = channel.ask(command);
    EXPECT_EQ(answer.kind, AnswerKind::kError) << command;
    EXPECT_NE(answer.error_code, 0);
  }
  EXPECT_EQ(channel.ask("dtrack2 tracking stop").kind, AnswerKind::kError) << "it does not track";
  EXPECT_EQ(channel.ask("dtrack2 tracking start").kind, AnswerKind::kOk);
  EXPECT_EQ(channel.ask("dtrack2 tracking start").kind, AnswerKind::kError) << "it does already";
}

TEST(Controller, GivesTheControlToTheFirst) {
  const Controller controller = controller_with();
  dtrack::CommandChannel first(options_for(controller));
  EXPECT_EQ(first.ask("dtrack2 get system access").value, "full");
  {
    dtrack::CommandChannel second(options_for(controller));
    EXPECT_EQ(second.ask("dtrack2 get system access").value, "none");
    EXPECT_EQ(second.ask("dtrack2 get system accessed_by").value, "127.0.0.1");
    EXPECT_EQ(second.ask("dtrack2 tracking start").kind, AnswerKind::kError);
    EXPECT_EQ(second.ask("dtrack2 get status active").kind, AnswerKind::kError);
  }
  const dtrack::CommandReport report = dtrack::start_tracking(options_for(controller));
  EXPECT_EQ(report.outcome, CommandOutcome::kRefused);
  EXPECT_THAT(report.text, HasSubstr("127.0.0.1 has the control"));
  EXPECT_FALSE(controller.tracking());
  EXPECT_EQ(first.ask("dtrack2 tracking start").kind, AnswerKind::kOk);
  EXPECT_TRUE(controller.tracking());
}

TEST(Controller, HandsTheControlOnWhenTheFirstLeaves) {
  const Controller controller = controller_with();
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(dtrack::query_tracker(options_for(controller)).state.full_access, true);
  }
}

TEST(Controller, MisbehavesWhereAsked) {
  const auto outcome = [](ControllerFault fault, std::chrono::milliseconds timeout) {
    const Controller controller = controller_with(fault);
    const auto answer = dtrack::start_tracking(options_for(controller, timeout));
    EXPECT_FALSE(controller.tracking());
    return answer.outcome;
  };
  constexpr std::chrono::milliseconds kShort{600};
  EXPECT_EQ(outcome(ControllerFault::kRefuse, kPatient), CommandOutcome::kUnreachable);
  EXPECT_EQ(outcome(ControllerFault::kGarbage, kPatient), CommandOutcome::kMalformed);
  EXPECT_EQ(outcome(ControllerFault::kError, kPatient), CommandOutcome::kRefused);
  EXPECT_EQ(outcome(ControllerFault::kBusy, kPatient), CommandOutcome::kRefused);
  EXPECT_EQ(outcome(ControllerFault::kSilent, kShort), CommandOutcome::kTimedOut);
  EXPECT_EQ(outcome(ControllerFault::kSlow, kShort), CommandOutcome::kTimedOut);
}

TEST(Controller, NamesEveryFault) {
  for (const std::string_view name : kControllerFaultNames) {
    ASSERT_TRUE(controller_fault_from_name(name).has_value());
  }
  EXPECT_EQ(controller_fault_from_name("busy"), ControllerFault::kBusy);
  EXPECT_EQ(controller_fault_from_name("refuse"), ControllerFault::kRefuse);
  EXPECT_FALSE(controller_fault_from_name("sulk").has_value());
}

TEST(Controller, ListensAgainOnItsPortAtOnce) {
  std::uint16_t port = 0;
  {
    const Controller controller = controller_with();
    port = controller.port();
    dtrack::start_tracking(options_for(controller));
  }
  const Controller controller({.port = port});
  EXPECT_EQ(controller.port(), port);
  EXPECT_FALSE(controller.tracking()) << "switched off and on";
}

TEST(Controller, SaysThatAPortIsTaken) {
  const Controller controller = controller_with();
  EXPECT_THROW(Controller({.port = controller.port()}), InputError);
  EXPECT_THROW(Controller({.bind_address = "here", .port = 0}), UsageError);
}

}  // namespace
}  // namespace handeye::simulator
