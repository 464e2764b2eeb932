// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/device_health.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kStart_ns = 5'000 * kSecond_ns;

/// A device at a steady rate, reported five times a second as the daemon does.
class SteadyDevice {
 public:
  explicit SteadyDevice(double rate_hz) : rate_hz_(rate_hz) {
    health_.set(device_status_t::STREAMING, "port 5000");
  }

  device_status_t run(double duration_s) {
    device_status_t status{};
    for (double t = 0; t < duration_s; t += 0.2) {
      now_ns_ += kSecond_ns / 5;
      received_ += rate_hz_ / 5;
      health_.received = static_cast<std::int64_t>(received_);
      if (rate_hz_ > 0) health_.last_ns = now_ns_;
      status = reporter_.report(health_, now_ns_);
    }
    return status;
  }
  void change_rate(double rate_hz) { rate_hz_ = rate_hz; }
  DeviceHealth& health() { return health_; }

 private:
  DeviceHealth health_;
  DeviceStatusReporter reporter_{1.0};
  double rate_hz_;
  double received_{0};
  std::int64_t now_ns_{kStart_ns};
};

TEST(DeviceStatus, OfADeviceThatWasNeverHeard) {
  DeviceHealth health;
  health.set(device_status_t::WAITING, "waiting for packets on port 5000");
  DeviceStatusReporter reporter(1.0);
  for (int i = 0; i < 20; ++i) {
    const device_status_t status = reporter.report(health, kStart_ns + i * kSecond_ns / 5);
    EXPECT_EQ(status.state, device_status_t::WAITING);
    EXPECT_EQ(status.text, "waiting for packets on port 5000");
    EXPECT_EQ(status.rate_hz, 0);
    EXPECT_EQ(status.age_s, -1);
  }
}

TEST(DeviceStatus, TellsTheRateOfTheLastSeconds) {
  SteadyDevice device(60);
  EXPECT_NEAR(device.run(1).rate_hz, 60, 1);
  EXPECT_NEAR(device.run(10).rate_hz, 60, 1);
  device.change_rate(25);
  EXPECT_NEAR(device.run(3).rate_hz, 25, 1) << "what was before is forgotten";
}

TEST(DeviceStatus, CallsADeviceSilentAndBack) {
  SteadyDevice device(60);
  EXPECT_EQ(device.run(3).state, device_status_t::STREAMING);
  device.change_rate(0);
  EXPECT_EQ(device.run(0.8).state, device_status_t::STREAMING) << "not at once";
  const device_status_t silent = device.run(3);
  EXPECT_EQ(silent.state, device_status_t::SILENT);
  EXPECT_NEAR(silent.age_s, 3.8, 0.3);
  EXPECT_EQ(silent.rate_hz, 0);
  EXPECT_THAT(silent.text, testing::HasSubstr("port 5000: nothing for"));
  EXPECT_THAT(silent.clock.text, testing::HasSubstr("this was before"));
  device.change_rate(60);
  EXPECT_EQ(device.run(1).state, device_status_t::STREAMING);
}

TEST(DeviceStatus, DoesNotCallADeviceSilentThatHasFailed) {
  SteadyDevice device(60);
  device.run(1);
  device.health().set(device_status_t::FAILED, "sends 640x480");
  device.change_rate(0);
  const device_status_t status = device.run(5);
  EXPECT_EQ(status.state, device_status_t::FAILED);
  EXPECT_EQ(status.text, "sends 640x480");
}

TEST(DeviceStatus, CarriesTheCounters) {
  DeviceHealth health;
  health.received = 1;
  health.dropped = 2;
  health.dropped_queue = 3;
  health.malformed = 4;
  health.restarts = 5;
  const device_status_t status = DeviceStatusReporter(1.0).report(health, kStart_ns);
  EXPECT_EQ(status.received, 1);
  EXPECT_EQ(status.dropped, 2);
  EXPECT_EQ(status.dropped_queue, 3);
  EXPECT_EQ(status.malformed, 4);
  EXPECT_EQ(status.restarts, 5);
}

TEST(DeviceHealth, TellsWhatIsKnownOfTheClock) {
  DeviceHealth health;
  DeviceStatusReporter reporter(2.0);
  EXPECT_EQ(reporter.report(health, 0).clock.state, clock_status_t::ABSENT);
  EXPECT_EQ(reporter.report(health, 0).clock.text, "nothing has come yet");
  health.last_ns = 1'000'000'000;
  EXPECT_EQ(reporter.report(health, 1'000'000'000).clock.text,
            "no time of its own: the arrivals stand for it");
  health.reordered = 7;
  health.set_clock({.state = ClockState::kSteady,
                    .drift_ppm = 12.5,
                    .jitter_ms = 1.5,
                    .span_s = 33,
                    .jumps = 2,
                    .midnights = 1});
  const device_status_t status = reporter.report(health, 1'000'000'000);
  EXPECT_EQ(status.reordered, 7);
  EXPECT_EQ(status.clock.state, clock_status_t::STEADY);
  EXPECT_EQ(status.clock.drift_ppm, 12.5);
  EXPECT_EQ(status.clock.jitter_ms, 1.5);
  EXPECT_EQ(status.clock.span_s, 33);
  EXPECT_EQ(status.clock.jumps, 2);
  EXPECT_EQ(status.clock.midnights, 1);
  EXPECT_TRUE(status.clock.text.empty());
  health.set_clock({.state = ClockState::kUnstable, .jumps = 3});
  EXPECT_FALSE(reporter.report(health, 2'000'000'000).clock.text.empty());
}

}  // namespace
}  // namespace handeye
