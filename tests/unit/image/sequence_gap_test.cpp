// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/image/sequence_gap.hpp"

#include <gtest/gtest.h>

namespace handeye {
namespace {

TEST(SequenceGap, CountsModulo32Bits) {
  EXPECT_EQ(sequence_gap(5, 6), 0U);
  EXPECT_EQ(sequence_gap(5, 9), 3U);
  EXPECT_EQ(sequence_gap(0xFFFF'FFFF, 0), 0U);
  EXPECT_EQ(sequence_gap(0xFFFF'FFFE, 2), 3U);
}

TEST(SequenceGap, IsNoneWhenTheCountRepeatsOrStartsAnew) {
  EXPECT_EQ(sequence_gap(7, 7), 0U);
  EXPECT_EQ(sequence_gap(1000, 0), 0U);
}

}  // namespace
}  // namespace handeye
