// SPDX-License-Identifier: BSD-3-Clause
#include "protocol/bus.hpp"

#include <algorithm>
#include <set>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <handeye/datagram_t.hpp>
#include <handeye/request_t.hpp>
#include <handeye/tracker_frame_t.hpp>

#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;

// Within one process, without network: what is published is heard by the same Bus.
constexpr const char* kInProcess = "memq://";
constexpr const char* kChannel = "ANY";

std::string problem_with(const std::string& url) {
  try {
    const Bus bus(url);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

request_t request_with(std::int64_t id) {
  request_t request{};
  request.request_id = id;
  return request;
}

TEST(BusUrl, MistakesAreNamedInOneLine) {
  const struct {
    const char* url;
    const char* word;
  } kCases[] = {
      {"udpm://10.0.0.1:7667?ttl=0", "'10.0.0.1' is not a multicast address"},
      {"udpm://240.0.0.1:7667", "not a multicast address"},
      {"udpm://room:7667", "'room' is not a multicast address"},
      {"udpm://239.255.76.67:0", "1..65535"},
      {"udpm://239.255.76.67:65536", "1..65535"},
      {"udpm://239.255.76.67:port", "1..65535"},
      {"carrier-pigeon://", "carrier-pigeon://"},
  };
  for (const auto& [url, word] : kCases) {
    const std::string problem = problem_with(url);
    EXPECT_THAT(problem, HasSubstr(word)) << url;
    EXPECT_THAT(problem, HasSubstr(url));
    EXPECT_THAT(problem, Not(HasSubstr("\n")));
  }
}

TEST(Bus, DeliversWhatWasPublished) {
  Bus bus(kInProcess);
  std::vector<std::int64_t> heard;
  bus.subscribe<request_t>(kChannel,
                           [&](const request_t& request) { heard.push_back(request.request_id); });
  Publisher<request_t> publisher(bus, kChannel);
  for (const std::int64_t id : {11, 12, 13}) {
    request_t request = request_with(id);
    ASSERT_TRUE(publisher.publish(request));
  }
  while (bus.handle(milliseconds(100))) {
  }
  EXPECT_THAT(heard, testing::ElementsAre(11, 12, 13));
  EXPECT_EQ(bus.undecodable(), 0U);
}

TEST(Bus, StampsEveryMessage) {
  Bus bus(kInProcess);
  std::vector<request_t> heard;
  bus.subscribe<request_t>(kChannel, [&](const request_t& request) { heard.push_back(request); });
  Publisher<request_t> publisher(bus, kChannel);
  const std::int64_t before_us = realtime_us();
  for (int i = 0; i < 3; ++i) {
    request_t request = request_with(1);
    publisher.publish(request);
  }
  while (bus.handle(milliseconds(100))) {
  }
  ASSERT_EQ(heard.size(), 3U);
  for (std::size_t i = 0; i < heard.size(); ++i) {
    EXPECT_EQ(heard[i].seq, static_cast<std::int64_t>(i));
    EXPECT_EQ(heard[i].session_id, bus.session_id());
    EXPECT_GE(heard[i].utime, before_us);
    EXPECT_LE(heard[i].utime, realtime_us());
  }
}

TEST(Bus, HandleReturnsWhenNothingComes) {
  Bus bus(kInProcess);
  EXPECT_FALSE(bus.handle(milliseconds(0)));
  EXPECT_FALSE(bus.handle(milliseconds(20)));
}

/// Publishes bytes as they are.
void publish_bytes(Bus& bus, const std::vector<std::uint8_t>& bytes) {
  bus.lcm().publish(kChannel, bytes.data(), static_cast<unsigned>(bytes.size()));
}

template <typename Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

TEST(Bus, CountsWhatItCannotDecode) {
  Bus bus(kInProcess);
  int heard = 0;
  bus.subscribe<datagram_t>(kChannel, [&](const datagram_t&) { ++heard; });

  datagram_t datagram{};
  datagram.size = 4;
  datagram.data = {1, 2, 3, 4};
  const std::vector<std::uint8_t> good = encoded(datagram);
  publish_bytes(bus, encoded(request_t{}));            // another type
  publish_bytes(bus, {});                              // nothing at all
  publish_bytes(bus, {good.begin(), good.end() - 1});  // cut short
  std::vector<std::uint8_t> absurd = good;
  const std::size_t length_at = good.size() - 8;
  for (std::size_t i = 0; i < 4; ++i) absurd[length_at + i] = i == 0 ? 0x7f : 0xff;
  publish_bytes(bus, absurd);  // claims two gigabytes
  absurd[length_at] = 0xff;
  publish_bytes(bus, absurd);  // claims -1 bytes
  publish_bytes(bus, good);
  while (bus.handle(milliseconds(100))) {
  }
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(bus.undecodable(), 5U);
}

TEST(Bus, PublishersOfSeveralThreadsDoNotDisturbEachOther) {
  Bus bus(kInProcess);
  constexpr int kThreads = 4;
  constexpr int kMessages = 50;  // all fit into the subscription's queue
  std::vector<std::vector<std::int64_t>> heard(kThreads);
  bus.subscribe<request_t>(kChannel, [&](const request_t& request) {
    heard[static_cast<std::size_t>(request.action)].push_back(request.request_id);
  });
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (int thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&bus, thread] {
      Publisher<request_t> publisher(bus, kChannel);
      for (int i = 0; i < kMessages; ++i) {
        request_t request = request_with(i);
        request.action = thread;
        publisher.publish(request);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  while (bus.handle(milliseconds(100))) {
  }
  for (const std::vector<std::int64_t>& ids : heard) {
    ASSERT_EQ(ids.size(), static_cast<std::size_t>(kMessages));
    EXPECT_TRUE(std::ranges::is_sorted(ids));
  }
}

TEST(RandomId, IsPositiveAndNeverTheSame) {
  std::set<std::int64_t> ids;
  for (int i = 0; i < 1000; ++i) ids.insert(random_id());
  EXPECT_EQ(ids.size(), 1000U);
  EXPECT_GT(*ids.begin(), 0);
}

}  // namespace
}  // namespace handeye
