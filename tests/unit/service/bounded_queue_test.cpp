// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/bounded_queue.hpp"

#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace handeye {
namespace {

using std::chrono::milliseconds;

TEST(BoundedQueue, KeepsTheOrder) {
  BoundedQueue<int> queue(4);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(queue.push(i));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(queue.pop(), i);
  EXPECT_EQ(queue.pop(), std::nullopt);
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(BoundedQueue, DropsTheNewOneWhenFullAndCountsIt) {
  BoundedQueue<int> queue(2);
  EXPECT_TRUE(queue.push(1));
  EXPECT_TRUE(queue.push(2));
  EXPECT_FALSE(queue.push(3));
  EXPECT_FALSE(queue.push(4));
  EXPECT_EQ(queue.dropped(), 2U);
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_TRUE(queue.push(5));
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), 5);
}

TEST(BoundedQueue, ForgetsWhatWaits) {
  BoundedQueue<int> queue(4);
  queue.push(1);
  queue.push(2);
  queue.clear();
  EXPECT_EQ(queue.pop(), std::nullopt);
  queue.push(3);
  EXPECT_EQ(queue.pop(), 3);
  EXPECT_EQ(queue.dropped(), 0U) << "forgetting on purpose is no loss";
}

TEST(BoundedQueue, WaitsForAValue) {
  BoundedQueue<int> queue(1);
  EXPECT_EQ(queue.pop(milliseconds(10)), std::nullopt);
  std::thread producer([&] { queue.push(7); });
  EXPECT_EQ(queue.pop(milliseconds(10'000)), 7);
  producer.join();
}

TEST(BoundedQueue, BetweenTwoThreadsEveryValueComesInOrderOrIsCounted) {
  constexpr int kValues = 100'000;
  BoundedQueue<int> queue(16);
  std::thread producer([&] {
    for (int i = 0; i < kValues; ++i) queue.push(i);
    while (!queue.push(kValues)) std::this_thread::yield();  // the end must arrive
  });
  std::int64_t taken = 0;
  int last = -1;
  while (last != kValues) {
    const auto value = queue.pop(milliseconds(10'000));
    ASSERT_TRUE(value.has_value()) << "after " << taken;
    ASSERT_GT(*value, last);
    last = *value;
    ++taken;
  }
  producer.join();
  // Attempts to send the end that found the queue full count as drops too, so "at least".
  EXPECT_GE(taken + static_cast<std::int64_t>(queue.dropped()), kValues + 1);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

TEST(BoundedQueue, WithRoomEnoughLosesNothing) {
  constexpr int kValues = 100'000;
  BoundedQueue<int> queue(kValues);
  std::thread producer([&] {
    for (int i = 0; i < kValues; ++i) queue.push(i);
  });
  for (int i = 0; i < kValues; ++i) {
    const auto value = queue.pop(milliseconds(10'000));
    ASSERT_EQ(value, i);
  }
  producer.join();
  EXPECT_EQ(queue.dropped(), 0U);
}

}  // namespace
}  // namespace handeye
