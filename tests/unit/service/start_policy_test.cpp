// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/start_policy.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handeye {
namespace {

using dtrack::CommandOutcome;
using testing::ElementsAre;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStart = 1000 * kSecond;  ///< of the clock, which never shows 0

/// Seconds since the policy's beginning, whole ones.
class PolicyRun {
 public:
  bool is_due(int second) { return policy_.is_due(at(second), packet_ns_); }
  void packet(int second) { packet_ns_ = at(second); }
  void note(int second, CommandOutcome outcome) { policy_.note({.outcome = outcome}, at(second)); }
  bool ours() const { return policy_.ours(); }
  bool has_given_up() const { return policy_.has_given_up(); }

  /// Every second from `first` to `last`; each attempt ends at once so. When there were any.
  std::vector<int> attempts(int first, int last, CommandOutcome outcome) {
    std::vector<int> seconds;
    for (int second = first; second <= last; ++second) {
      if (!is_due(second)) continue;
      note(second, outcome);
      seconds.push_back(second);
    }
    return seconds;
  }
  /// A packet every second.
  bool asks_while_packets_come(int first, int last) {
    bool asked = false;
    for (int second = first; second <= last; ++second) {
      packet(second);
      asked = is_due(second) || asked;
    }
    return asked;
  }

 private:
  static std::int64_t at(int second) { return kStart + second * kSecond; }

  StartPolicy policy_{kStart};
  std::int64_t packet_ns_{0};
};

TEST(StartPolicy, AsksAtTheBeginningWhereNothingComes) {
  PolicyRun run;
  EXPECT_FALSE(run.is_due(0));
  EXPECT_TRUE(run.is_due(1));
}

TEST(StartPolicy, AsksNothingWhilePacketsCome) {
  PolicyRun run;
  EXPECT_FALSE(run.asks_while_packets_come(0, 100));
  EXPECT_FALSE(run.is_due(104));
  EXPECT_TRUE(run.is_due(105)) << "five seconds of silence";
}

TEST(StartPolicy, WaitsLongerFromAttemptToAttempt) {
  PolicyRun run;
  EXPECT_THAT(run.attempts(0, 300, CommandOutcome::kUnreachable),
              ElementsAre(1, 6, 16, 36, 76, 136, 196, 256));
}

TEST(StartPolicy, WaitsForAControllerThatIsSwitchedOnTomorrow) {
  PolicyRun run;
  run.attempts(0, 20'000, CommandOutcome::kUnreachable);
  EXPECT_FALSE(run.has_given_up());
  EXPECT_THAT(run.attempts(20'001, 20'060, CommandOutcome::kDone), testing::SizeIs(1));
}

TEST(StartPolicy, GivesUpOnAControllerThatRefuses) {
  for (const CommandOutcome outcome : {CommandOutcome::kRefused, CommandOutcome::kMalformed,
                                       CommandOutcome::kTimedOut, CommandOutcome::kAlready}) {
    PolicyRun run;
    EXPECT_THAT(run.attempts(0, 20'000, outcome), testing::SizeIs(8));
    EXPECT_TRUE(run.has_given_up());
    EXPECT_FALSE(run.ours());

    EXPECT_FALSE(run.asks_while_packets_come(20'001, 20'002));
    EXPECT_FALSE(run.has_given_up()) << "packets came, so it begins anew";
    EXPECT_THAT(run.attempts(20'003, 20'012, outcome), ElementsAre(20'007, 20'012));
  }
}

TEST(StartPolicy, WhatWasOnAlreadyIsNotOurs) {
  PolicyRun run;
  run.attempts(0, 1, CommandOutcome::kAlready);
  EXPECT_FALSE(run.ours());
}

TEST(StartPolicy, WhatWasStartedIsOursWhileItRuns) {
  PolicyRun run;
  run.attempts(0, 1, CommandOutcome::kDone);
  EXPECT_TRUE(run.ours());
  // Cameras take their time; the controller says then that it tracks already.
  EXPECT_THAT(run.attempts(2, 6, CommandOutcome::kAlready), ElementsAre(6));
  EXPECT_TRUE(run.ours());
  EXPECT_FALSE(run.asks_while_packets_come(7, 1000));
  EXPECT_TRUE(run.ours());
}

TEST(StartPolicy, WhatCameBackByItselfIsNoLongerOurs) {
  PolicyRun run;
  run.attempts(0, 1, CommandOutcome::kDone);
  run.asks_while_packets_come(2, 10);
  EXPECT_TRUE(run.ours());
  run.attempts(11, 20, CommandOutcome::kRefused);
  EXPECT_FALSE(run.ours());
  run.asks_while_packets_come(21, 30);
  EXPECT_FALSE(run.ours()) << "somebody else started it";
}

TEST(StartPolicy, StartsAgainWhatWasStopped) {
  PolicyRun run;
  run.attempts(0, 1, CommandOutcome::kDone);
  run.asks_while_packets_come(2, 10);
  EXPECT_THAT(run.attempts(11, 16, CommandOutcome::kDone), ElementsAre(15));
  EXPECT_TRUE(run.ours());
}

}  // namespace
}  // namespace handeye
