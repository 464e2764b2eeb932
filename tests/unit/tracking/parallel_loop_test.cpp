// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/parallel_loop.hpp"

#include <atomic>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace handeye {
namespace {

TEST(ParallelLoop, RunsEveryPassOnce) {
  for (const int threads : {1, 2, 4}) {
    ParallelLoop loop(threads);
    for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 1000U}) {
      std::vector<int> runs(count, 0);
      for (int round = 0; round < 20; ++round) {
        loop.run(count, [&](std::size_t i) { ++runs[i]; });
      }
      for (const int passes : runs) EXPECT_EQ(passes, 20);
    }
  }
}

/// More threads than cores and next to no work: most helpers come when the loop is over, or when
/// the next has begun. Each loop's passes belong to it alone.
TEST(ParallelLoop, IsNotDisturbedByHelpersThatComeLate) {
  ParallelLoop loop(6);
  for (std::size_t round = 0; round < 4000; ++round) {
    const std::size_t count = 9 + round % 40;
    std::vector<std::size_t> rounds(count, 0);
    loop.run(count, [&rounds, round](std::size_t i) { rounds[i] += round + 1; });
    for (const std::size_t seen : rounds) ASSERT_EQ(seen, round + 1);
  }
}

TEST(ParallelLoop, IsOverWhenTheLastPassIsDone) {
  ParallelLoop loop(3);
  for (int round = 0; round < 200; ++round) {
    std::atomic<int> done{0};
    loop.run(64, [&done](std::size_t i) {
      double work = 0;
      for (std::size_t k = 0; k < 50 * i; ++k) work += std::sqrt(static_cast<double>(k));
      if (work >= 0) ++done;
    });
    ASSERT_EQ(done, 64);
  }
}

}  // namespace
}  // namespace handeye
