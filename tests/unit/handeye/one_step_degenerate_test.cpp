// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_degenerate.hpp"

#include <gtest/gtest.h>

/// Motions that do not suffice (docs/math.md section 10), from nothing at all to a good one: each
/// refused with its own reason, none accepted wrongly, on one_step's answer and on the
/// likelihood's.
namespace handeye {
namespace {

using synthetic::Degenerate;
using synthetic::degenerate_motions;
using synthetic::Verdicts;
using synthetic::verdicts;

constexpr double kHonest = 3.5;  // error in its own standard deviations
constexpr std::uint32_t kSeeds = 2;

class OneStepDegenerate : public testing::TestWithParam<std::size_t> {
 protected:
  const Degenerate& motion() const { return degenerate_motions()[GetParam()]; }
};

TEST_P(OneStepDegenerate, IsRefusedWithItsOwnReason) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Verdicts found = verdicts(motion(), 0, seed);
    EXPECT_EQ(found.likelihood.judgement.problem, motion().problem) << seed;
    EXPECT_EQ(found.likelihood.judgement.missing, motion().missing) << seed;
    EXPECT_EQ(found.one_step.judgement.problem, motion().problem) << seed;
    EXPECT_EQ(found.one_step.judgement.missing, motion().missing) << seed;
  }
}

TEST_P(OneStepDegenerate, IsNeverAcceptedWrongly) {
  for (const double amplitude : {0.003, 0.01, 0.03, 0.1, 0.3}) {
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const Verdicts found = verdicts(motion(), amplitude, seed);
      for (const synthetic::Verdict* verdict : {&found.one_step, &found.likelihood}) {
        if (!verdict->accepted()) continue;
        EXPECT_LT(verdict->rotation_in_sigmas, kHonest) << amplitude << " seed " << seed;
        EXPECT_LT(verdict->translation_in_sigmas, kHonest) << amplitude << " seed " << seed;
      }
    }
  }
}

TEST_P(OneStepDegenerate, IsAcceptedOnceWhatWasMissingIsThere) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Verdicts found = verdicts(motion(), 1, seed, 260);
    EXPECT_TRUE(found.one_step.accepted()) << seed;
    EXPECT_LT(found.one_step.rotation_in_sigmas, kHonest) << seed;
    EXPECT_LT(found.one_step.translation_in_sigmas, kHonest) << seed;
  }
}

std::string name_of(const testing::TestParamInfo<std::size_t>& info) {
  return degenerate_motions()[info.param].name;
}

INSTANTIATE_TEST_SUITE_P(Motions, OneStepDegenerate,
                         testing::Range<std::size_t>(0, degenerate_motions().size()), name_of);

}  // namespace
}  // namespace handeye
