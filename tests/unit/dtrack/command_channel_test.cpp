// SPDX-License-Identifier: BSD-3-Clause
// The channel against everything that may be at the other end. Nothing here may take longer than
// its time-out, and a test that waits for one waits for a short one.
#include "drivers/dtrack/command_channel.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/exit_codes.hpp"
#include "tests/unit/dtrack/scripted_controller.hpp"

namespace handeye::dtrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;

/// Where an answer is expected: never reached. Where a time-out is: short.
constexpr milliseconds kPatient{30'000};
constexpr milliseconds kShort{200};

CommandOptions options_for(std::uint16_t port, milliseconds timeout) {
  return {.controller = "127.0.0.1", .port = port, .connect_timeout = timeout, .timeout = timeout};
}

/// What "dtrack2 tracking start" comes to with a controller that answers so.
CommandAnswer answer_to(const std::function<void(Peer&)>& script, milliseconds timeout = kPatient) {
  const ScriptedController controller(script);
  return CommandChannel(options_for(controller.port(), timeout)).ask("dtrack2 tracking start");
}

TEST(CommandChannel, SendsTheCommandWithItsNulAndReadsTheAnswer) {
  std::atomic<bool> as_asked{false};
  const CommandAnswer answer = answer_to([&](Peer& peer) {
    as_asked = peer.command() == "dtrack2 tracking start";
    peer.answer("dtrack2 ok");
    peer.wait_for_the_end();
  });
  EXPECT_EQ(answer.kind, AnswerKind::kOk) << answer.text;
  EXPECT_TRUE(as_asked);
}

TEST(CommandChannel, AsksSeveralTimesOnOneConnection) {
  std::atomic<int> connections{0};
  const ScriptedController controller([&](Peer& peer) {
    ++connections;
    while (const auto command = peer.command()) {
      peer.answer("dtrack2 set heard command " + *command);
    }
  });
  CommandChannel channel(options_for(controller.port(), kPatient));
  EXPECT_EQ(channel.ask("one").value, "one");
  EXPECT_EQ(channel.ask("two").value, "two");
  EXPECT_EQ(channel.ask("three words here").value, "three words here");
  EXPECT_EQ(connections, 1);
}

TEST(CommandChannel, LetsGoWithTheObject) {
  std::atomic<bool> closed{false};
  const ScriptedController controller([&](Peer& peer) {
    peer.command();
    peer.answer("dtrack2 ok");
    peer.wait_for_the_end();
    closed = !peer.stop().stop_requested();
  });
  EXPECT_EQ(CommandChannel(options_for(controller.port(), kPatient)).ask("x").kind,
            AnswerKind::kOk);
  const auto deadline = steady_clock::now() + kPatient;
  while (!closed && steady_clock::now() < deadline) std::this_thread::sleep_for(milliseconds(2));
  EXPECT_TRUE(closed);
}

TEST(CommandChannel, TakesAnAnswerThatComesByteByByte) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    for (const char byte : std::string("dtrack2 err 4 \"no\"") + '\0') {
      peer.write({&byte, 1});
      std::this_thread::sleep_for(milliseconds(2));
    }
    peer.wait_for_the_end();
  });
  EXPECT_EQ(answer.kind, AnswerKind::kError);
  EXPECT_EQ(answer.error_code, 4);
}

TEST(CommandChannel, TakesAnAnswerAfterWhichTheControllerCloses) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    peer.answer("dtrack2 ok");
  });
  EXPECT_EQ(answer.kind, AnswerKind::kOk) << answer.text;
}

TEST(CommandChannel, ToleratesALineEndBehindTheNul) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    peer.write({"dtrack2 ok\0\r\n", 13});
    peer.wait_for_the_end();
  });
  EXPECT_EQ(answer.kind, AnswerKind::kOk) << answer.text;
}

TEST(CommandChannel, RefusesTwoAnswersToOneCommand) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    peer.write({"dtrack2 ok\0dtrack2 ok\0", 22});
    peer.wait_for_the_end();
  });
  EXPECT_EQ(answer.kind, AnswerKind::kMalformed);
  EXPECT_THAT(answer.text, HasSubstr("nobody asked for"));
}

TEST(CommandChannel, RefusesGarbage) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    peer.answer("HTTP/1.1 400 Bad Request\r\nConnection: close\r\n\r\n");
    peer.wait_for_the_end();
  });
  EXPECT_EQ(answer.kind, AnswerKind::kMalformed);
  EXPECT_THAT(answer.text, HasSubstr("HTTP/1.1 400"));
}

TEST(CommandChannel, RefusesAnEmptyAnswer) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    peer.answer("");
    peer.wait_for_the_end();
  });
  EXPECT_EQ(answer.kind, AnswerKind::kMalformed);
}

TEST(CommandChannel, ReadsNoMoreThanAnAnswerCanHave) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    while (!peer.stop().stop_requested() && peer.write(std::string(100, 'x'))) {
    }
  });
  EXPECT_EQ(answer.kind, AnswerKind::kMalformed);
  EXPECT_THAT(answer.text, HasSubstr("no end within 1024 bytes"));
}

TEST(CommandChannel, ReadsTheLongestAnswerThereMayBe) {
  const std::string longest =
      "dtrack2 set a b " +
      std::string(kLongestAnswer - std::string("dtrack2 set a b ").size(), 'v');
  const auto script = [&](const std::string& text) {
    return [text](Peer& peer) {
      peer.command();
      peer.answer(text);
      peer.wait_for_the_end();
    };
  };
  EXPECT_EQ(answer_to(script(longest)).kind, AnswerKind::kValue);
  EXPECT_EQ(answer_to(script(longest + "v")).kind, AnswerKind::kMalformed);
}

TEST(CommandChannel, TellsAConnectionThatEndsWithinAnAnswer) {
  const CommandAnswer answer = answer_to([](Peer& peer) {
    peer.command();
    peer.write("dtrack2 o");
  });
  EXPECT_EQ(answer.kind, AnswerKind::kMalformed);
  EXPECT_THAT(answer.text, HasSubstr("'dtrack2 o'"));
}

TEST(CommandChannel, TellsAConnectionThatIsClosedAtOnce) {
  EXPECT_EQ(answer_to([](Peer&) {}).kind, AnswerKind::kUnreachable);
  const CommandAnswer answer = answer_to([](Peer& peer) { peer.command(); });
  EXPECT_EQ(answer.kind, AnswerKind::kUnreachable);
  EXPECT_THAT(answer.text, HasSubstr("closed without an answer"));
}

TEST(CommandChannel, GivesUpOnSilence) {
  const auto begin = steady_clock::now();
  const CommandAnswer answer = answer_to([](Peer& peer) { peer.wait_for_the_end(); }, kShort);
  EXPECT_EQ(answer.kind, AnswerKind::kTimedOut);
  EXPECT_THAT(answer.text, HasSubstr("no answer within 0.2 s"));
  EXPECT_GE(steady_clock::now() - begin, kShort);
}

TEST(CommandChannel, GivesUpOnAnAnswerWithoutNul) {
  const CommandAnswer answer = answer_to(
      [](Peer& peer) {
        peer.command();
        peer.write("dtrack2 ok");
        peer.wait_for_the_end();
      },
      kShort);
  EXPECT_EQ(answer.kind, AnswerKind::kTimedOut);
  EXPECT_THAT(answer.text, HasSubstr("only 'dtrack2 ok' came"));
}

TEST(CommandChannel, ADripDoesNotProlongTheTime) {
  std::atomic<int> bytes{0};
  const CommandAnswer answer = answer_to(
      [&](Peer& peer) {
        peer.command();
        while (!peer.stop().stop_requested() && peer.write("x")) {
          ++bytes;
          std::this_thread::sleep_for(milliseconds(20));
        }
      },
      kShort);
  EXPECT_EQ(answer.kind, AnswerKind::kTimedOut);
  EXPECT_LT(bytes, 1000) << "the channel let go before its room was full";
}

TEST(CommandChannel, TellsThatNobodyListens) {
  const ListeningPort deaf(std::nullopt);
  const CommandAnswer answer = CommandChannel(options_for(deaf.port(), kPatient)).ask("x");
  EXPECT_EQ(answer.kind, AnswerKind::kUnreachable);
  EXPECT_EQ(answer.text, "Connection refused");
}

TEST(CommandChannel, GivesUpWherePacketsVanish) {
  const BlackHole hole;
  const CommandAnswer answer = CommandChannel(options_for(hole.port(), kShort)).ask("x");
  EXPECT_EQ(answer.kind, AnswerKind::kUnreachable);
  EXPECT_EQ(answer.text, "nobody there within 0.2 s");
}

TEST(CommandChannel, TheWholeTimeLimitsTheConnectionToo) {
  const BlackHole hole;
  CommandOptions options = options_for(hole.port(), kShort);
  options.connect_timeout = kPatient;
  EXPECT_EQ(CommandChannel(options).ask("x").kind, AnswerKind::kUnreachable);
}

TEST(CommandChannel, TellsAnAddressWithoutARoute) {
  CommandOptions options = options_for(50105, kPatient);
  options.controller = "255.255.255.255";
  const CommandAnswer answer = CommandChannel(options).ask("x");
  EXPECT_EQ(answer.kind, AnswerKind::kUnreachable);
  EXPECT_FALSE(answer.text.empty());
}

TEST(CommandChannel, RefusesWhatIsNoAddress) {
  EXPECT_THROW(CommandChannel({.controller = "artcontroller"}), UsageError);
  EXPECT_THROW(CommandChannel({.controller = ""}), UsageError);
}

TEST(CommandChannel, EndsWhenToldTo) {
  const auto ends_early = [](std::uint16_t port) {
    std::stop_source source;
    CommandChannel channel(options_for(port, kPatient), source.get_token());
    const std::jthread stopping([&source] {
      std::this_thread::sleep_for(milliseconds(50));
      source.request_stop();
    });
    return channel.ask("x").kind;
  };
  const ScriptedController silent([](Peer& peer) { peer.wait_for_the_end(); });
  EXPECT_EQ(ends_early(silent.port()), AnswerKind::kInterrupted) << "while waiting for an answer";
  const BlackHole hole;
  EXPECT_EQ(ends_early(hole.port()), AnswerKind::kInterrupted) << "while connecting";
}

TEST(CommandChannel, ALateAnswerIsNotTakenForTheNextOne) {
  std::atomic<int> connections{0};
  const ScriptedController controller([&](Peer& peer) {
    const bool first = ++connections == 1;
    peer.command();
    peer.answer(first ? "nonsense" : "dtrack2 ok");
    peer.answer("dtrack2 set late answer here");
    peer.wait_for_the_end();
  });
  CommandChannel channel(options_for(controller.port(), kPatient));
  EXPECT_EQ(channel.ask("x").kind, AnswerKind::kMalformed);
  // A connection of its own; whether the second answer is there yet is a matter of chance.
  EXPECT_NE(channel.ask("y").kind, AnswerKind::kValue);
  EXPECT_EQ(connections, 2);
}

}  // namespace
}  // namespace handeye::dtrack
