// SPDX-License-Identifier: BSD-3-Clause
#include "client/library/client.hpp"

#include <gtest/gtest.h>

#include "protocol/exit_codes.hpp"
#include "tests/unit/client/scripted_daemon.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;
using test::ScriptedDaemon;

/// Spins until the condition holds; false when it does not within ten seconds.
template <typename Condition>
bool spin_until(Client& client, Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!condition() && std::chrono::steady_clock::now() < deadline) {
    client.spin_once(milliseconds(5));
  }
  return condition();
}

class ClientTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto problem = test::lcm_problem()) GTEST_SKIP() << *problem;
  }

  ClientOptions options() const {
    ClientOptions options;
    options.lcm_url = provider_;
    options.request_period = milliseconds(40);
    return options;
  }

  std::string provider_ = test::private_provider();
};

TEST_F(ClientTest, RepeatsARequestUnderOneIdUntilItIsAcknowledged) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    if (self.times_heard(request.request_id) == 3) self.acknowledge(request);
  });
  Client client(options());
  const std::int64_t id = client.start({});
  EXPECT_TRUE(client.next_send_in().has_value());
  ASSERT_TRUE(spin_until(client, [&] { return client.acknowledgement(id).has_value(); }));

  EXPECT_TRUE(client.acknowledgement(id)->taken());
  EXPECT_FALSE(client.next_send_in().has_value());
  EXPECT_EQ(daemon.distinct_ids(request_t::START), std::vector<std::int64_t>{id});
  EXPECT_GE(daemon.requests().size(), 3u);
}

TEST_F(ClientTest, StopsRepeatingOnceAcknowledged) {
  ScriptedDaemon daemon(
      provider_, [](ScriptedDaemon& self, const request_t& request) { self.acknowledge(request); });
  Client client(options());
  const std::int64_t id = client.describe();
  ASSERT_TRUE(spin_until(client, [&] { return client.acknowledgement(id).has_value(); }));
  // Messages of one sender arrive in order: once the marker is heard, all of the earlier are.
  const std::int64_t marker = client.finish();
  ASSERT_TRUE(spin_until(client, [&] { return client.acknowledgement(marker).has_value(); }));
  const int heard = daemon.times_heard(id);
  const auto later = std::chrono::steady_clock::now() + 10 * options().request_period;
  spin_until(client, [&] { return std::chrono::steady_clock::now() > later; });
  EXPECT_EQ(daemon.times_heard(id), heard);
}

TEST_F(ClientTest, CarriesWhatIsWanted) {
  ScriptedDaemon daemon(
      provider_, [](ScriptedDaemon& self, const request_t& request) { self.acknowledge(request); });
  Client client(options());
  StartRequest wanted;
  wanted.body_id = 7;
  wanted.wanted_sigma_rotation_deg = 0.2;
  wanted.wanted_sigma_translation_mm = 0.9;
  wanted.max_duration_s = 12.5;
  const std::int64_t start = client.start(wanted);
  const std::int64_t cancel = client.cancel(start);
  const std::int64_t record = client.record(3.5);
  ASSERT_TRUE(spin_until(client, [&] {
    return client.acknowledgement(start) && client.acknowledgement(cancel) &&
           client.acknowledgement(record);
  }));

  const auto requests = daemon.requests();
  ASSERT_GE(requests.size(), 3u);
  EXPECT_EQ(requests[0].action, +request_t::START);
  EXPECT_EQ(requests[0].protocol_version, +request_t::VERSION);
  EXPECT_EQ(requests[0].body_id, 7);
  EXPECT_EQ(requests[0].wanted_sigma_rotation_deg, 0.2);
  EXPECT_EQ(requests[0].wanted_sigma_translation_mm, 0.9);
  EXPECT_EQ(requests[0].max_duration_s, 12.5);
  EXPECT_EQ(requests[1].action, +request_t::CANCEL);
  EXPECT_EQ(requests[1].target_request_id, start);
  EXPECT_EQ(requests[2].action, +request_t::RECORD);
  EXPECT_EQ(requests[2].max_duration_s, 3.5);
  EXPECT_NE(start, cancel);
}

TEST_F(ClientTest, KeepsTheTextOfARefusal) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    self.acknowledge(request, status_t::ACK_NOTHING_TO_DO, "no calibration is running");
  });
  Client client(options());
  const std::int64_t id = client.cancel();
  ASSERT_TRUE(spin_until(client, [&] { return client.acknowledgement(id).has_value(); }));
  EXPECT_FALSE(client.acknowledgement(id)->taken());
  EXPECT_EQ(client.acknowledgement(id)->code, +status_t::ACK_NOTHING_TO_DO);
  EXPECT_EQ(client.acknowledgement(id)->text, "no calibration is running");
}

TEST_F(ClientTest, HandsOutStatusAndResult) {
  ScriptedDaemon daemon(provider_, [](ScriptedDaemon& self, const request_t& request) {
    self.acknowledge(request);
    self.send_result(test::result_message(42, result_t::ACCEPTED));
  });
  Client client(options());
  int statuses = 0;
  std::int64_t result_id = 0;
  client.on_status([&](const status_t& status) {
    ++statuses;
    EXPECT_EQ(status.software_version, "1.2.3");
  });
  client.on_result([&](const result_t& result) { result_id = result.request_id; });
  client.describe();
  EXPECT_TRUE(spin_until(client, [&] { return statuses > 0 && result_id == 42; }));
  EXPECT_TRUE(client.last_status().has_value());
}

TEST_F(ClientTest, CountsMessagesOfAnotherType) {
  Client client(options());
  Bus bus(provider_);
  Publisher<result_t> wrong(bus, Channels().status);
  EXPECT_TRUE(spin_until(client, [&] {
    result_t message = test::result_message(1, result_t::ACCEPTED);
    wrong.publish(message);
    return client.undecodable() > 0;
  }));
  EXPECT_FALSE(client.last_status().has_value());
}

TEST(ClientOptionsTest, RefusesAPrefixThatLcmWouldReadAsAPattern) {
  ClientOptions options;
  options.channel_prefix = "ROOM.*";
  EXPECT_THROW(Client client(options), UsageError);
}

TEST(ClientOptionsTest, RefusesAnAddressThatIsNoMulticastGroup) {
  ClientOptions options;
  options.lcm_url = "udpm://10.0.0.1:7667";
  EXPECT_THROW(Client client(options), InputError);
}

}  // namespace
}  // namespace handeye
