// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/exchange.hpp"

#include <algorithm>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace handeye {
namespace {

using std::chrono::milliseconds;

/// Something large: it shows when two threads have it at a time.
struct Item {
  std::vector<int> values = std::vector<int>(256);
  void fill(int value) { std::ranges::fill(values, value); }
  bool is_uniform() const {
    return std::ranges::all_of(values, [this](int value) { return value == values.front(); });
  }
};

TEST(Exchange, CirculatesAFixedSetOfObjects) {
  Exchange<Item> exchange(3);
  std::set<Item*> seen;
  for (int round = 0; round < 10; ++round) {
    Item* item = exchange.acquire();
    ASSERT_NE(item, nullptr);
    seen.insert(item);
    exchange.commit(item);
    EXPECT_EQ(exchange.take(milliseconds(0)), item);
    exchange.release(item);
  }
  EXPECT_EQ(seen.size(), 3U);
}

TEST(Exchange, HandsOverInOrder) {
  Exchange<Item> exchange(3);
  for (int i = 0; i < 3; ++i) {
    Item* item = exchange.acquire();
    item->fill(i);
    exchange.commit(item);
  }
  EXPECT_EQ(exchange.waiting(), 3);
  for (int i = 0; i < 3; ++i) {
    Item* item = exchange.take(milliseconds(0));
    ASSERT_NE(item, nullptr);
    EXPECT_EQ(item->values.front(), i);
    exchange.release(item);
  }
  EXPECT_EQ(exchange.waiting(), 0);
}

TEST(Exchange, HasNothingFreeWhenAllAreOutAndNothingFilledWhenNoneIs) {
  Exchange<Item> exchange(1);
  EXPECT_EQ(exchange.take(milliseconds(10)), nullptr);
  Item* item = exchange.acquire();
  EXPECT_EQ(exchange.acquire(), nullptr) << "the producer has it";
  exchange.commit(item);
  EXPECT_EQ(exchange.acquire(), nullptr) << "it waits";
  ASSERT_EQ(exchange.take(milliseconds(0)), item);
  EXPECT_EQ(exchange.acquire(), nullptr) << "the consumer has it";
  exchange.release(item);
  EXPECT_EQ(exchange.acquire(), item);
}

TEST(Exchange, CountsWhatTheProducerHadNoRoomFor) {
  Exchange<Item> exchange(1);
  exchange.acquire();
  EXPECT_EQ(exchange.dropped(), 0U);
  exchange.count_drop();
  EXPECT_EQ(exchange.dropped(), 1U);
}

TEST(Exchange, BetweenTwoThreadsNothingIsSharedAndNothingLostUncounted) {
  constexpr int kItems = 50'000;
  Exchange<Item> exchange(4);
  std::thread producer([&] {
    for (int i = 1; i <= kItems; ++i) {
      Item* item = exchange.acquire();
      // The last one must arrive; of the others some may find no room.
      while (item == nullptr && i == kItems) item = exchange.acquire();
      if (item == nullptr) {
        exchange.count_drop();
        continue;
      }
      item->fill(i);
      exchange.commit(item);
    }
  });
  int last = 0;
  std::int64_t taken = 0;
  while (last != kItems) {
    Item* item = exchange.take(milliseconds(10'000));
    ASSERT_NE(item, nullptr) << "after " << taken;
    ASSERT_TRUE(item->is_uniform()) << "written while it was read";
    ASSERT_GT(item->values.front(), last);
    last = item->values.front();
    ++taken;
    exchange.release(item);
  }
  producer.join();
  EXPECT_EQ(taken + static_cast<std::int64_t>(exchange.dropped()), kItems);
}

}  // namespace
}  // namespace handeye
