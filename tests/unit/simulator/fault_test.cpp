// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/fault.hpp"

#include <gmock/gmock.h>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

TEST(Fault, IsReadFromItsSpelling) {
  EXPECT_EQ(tracker_fault("occlusion"), (Fault{FaultKind::kOcclusion, {}, 2.0}));
  EXPECT_EQ(tracker_fault("occlusion@8=1.5"), (Fault{FaultKind::kOcclusion, 8.0, 1.5}));
  EXPECT_EQ(tracker_fault("lost=0.2"), (Fault{FaultKind::kLost, {}, 0.2}));
  EXPECT_EQ(tracker_fault("clock-jump@10=-0.3"), (Fault{FaultKind::kClockJump, 10.0, -0.3}));
  EXPECT_EQ(camera_fault("stall@8"), (Fault{FaultKind::kStall, 8.0, 0.5}));
}

TEST(Fault, IsWrittenAsItIsRead) {
  const std::vector<Fault> faults{tracker_fault("clock-jump@10=3600"), tracker_fault("bursts")};
  EXPECT_EQ(spelling(faults), "clock-jump@10=3600,bursts=0.2");
  EXPECT_EQ(spelling(std::vector<Fault>{}), "none");
}

TEST(Fault, SaysWhatIsWrongWithASpelling) {
  for (const char* const text :
       {"", "fog", "stall", "lost@3", "lost=2", "lost=", "lost=x", "occlusion@", "occlusion@x",
        "occlusion=0", "bursts=5", "clock-jump=nan", "clock-jump=1e9", "lost =0.1"}) {
    try {
      tracker_fault(text);
      ADD_FAILURE() << text;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr(std::string("'") + text + "'"),
                                               testing::Not(testing::HasSubstr("\n"))));
    }
  }
  EXPECT_THROW(camera_fault("occlusion"), UsageError);
}

TEST(Fault, DrawsATimeWhereNoneIsGiven) {
  const std::vector<Fault> faults{tracker_fault("occlusion"), tracker_fault("occlusion"),
                                  tracker_fault("occlusion@1"), tracker_fault("lost")};
  const auto timed = with_times(faults, 5);
  ASSERT_EQ(timed.size(), 4U);
  for (const std::size_t drawn : {0U, 1U}) {
    EXPECT_GE(timed[drawn].at_s.value(), 3.0);
    EXPECT_LE(timed[drawn].at_s.value(), 7.0);
  }
  EXPECT_NE(timed[0].at_s, timed[1].at_s);
  EXPECT_EQ(timed[2].at_s, 1.0);
  EXPECT_FALSE(timed[3].at_s.has_value());
  EXPECT_EQ(with_times(faults, 5), timed);
  EXPECT_NE(with_times(faults, 6), timed);
}

TEST(Fault, HappensInItsTime) {
  const std::vector<Fault> faults{tracker_fault("occlusion@3=2"), tracker_fault("occlusion@4=3"),
                                  tracker_fault("clock-jump@5=0.5"),
                                  tracker_fault("clock-jump@6=-2")};
  EXPECT_FALSE(interval_end_s(faults, FaultKind::kOcclusion, 2.99).has_value());
  EXPECT_EQ(interval_end_s(faults, FaultKind::kOcclusion, 3.0), 5.0);
  EXPECT_EQ(interval_end_s(faults, FaultKind::kOcclusion, 4.5), 7.0);
  EXPECT_FALSE(interval_end_s(faults, FaultKind::kOcclusion, 7.0).has_value());
  EXPECT_EQ(sum_until(faults, FaultKind::kClockJump, 4.9), 0.0);
  EXPECT_EQ(sum_until(faults, FaultKind::kClockJump, 5.0), 0.5);
  EXPECT_EQ(sum_until(faults, FaultKind::kClockJump, 60.0), -1.5);
}

}  // namespace
}  // namespace handeye::simulator
