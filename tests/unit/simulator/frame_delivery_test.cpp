// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/frame_delivery.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace handeye::simulator {
namespace {

constexpr std::int64_t kStartNs = 9'000'000'000;

SimulatorOptions with(const char* fault) {
  SimulatorOptions options{.seed = 5};
  options.camera_faults.push_back(camera_fault(fault));
  return options;
}

TEST(FrameDelivery, LosesMostOfAStallAndHoldsBackItsFirst) {
  const World world(with("stall@2=0.5"), kStartNs);
  const FrameDelivery delivery(world);
  std::vector<int> lost;
  std::int64_t last_ns = 0;
  for (int number = 0; number < 100; ++number) {
    const double exposed_s = number / 25.0;
    EXPECT_NEAR(static_cast<double>(delivery.timestamp_ns(exposed_s)),
                static_cast<double>(world.host_ns(exposed_s + world.camera_delay_s)), 1);
    const auto arrival_ns = delivery.arrival_ns(exposed_s);
    if (!arrival_ns) {
      lost.push_back(number);
      continue;
    }
    EXPECT_GT(*arrival_ns, last_ns);
    last_ns = *arrival_ns;
    const bool held = number >= 50 && number < 54;
    const double late_s =
        1e-9 * static_cast<double>(*arrival_ns - delivery.timestamp_ns(exposed_s));
    if (held) {
      EXPECT_NEAR(late_s, 2.5 - exposed_s, 0.01) << number;
    } else {
      EXPECT_NEAR(late_s, 0.002, 1e-6) << number;
    }
  }
  EXPECT_EQ(lost, (std::vector<int>{54, 55, 56, 57, 58, 59, 60, 61, 62}));
}

TEST(FrameDelivery, StampsJumpAndArrivalsDoNot) {
  const World world(with("stamp-jump@2=-0.3"), kStartNs);
  const World usual({.seed = 5}, kStartNs);
  for (const double exposed_s : {0.0, 1.96, 2.0, 3.0}) {
    const double wrong_s = 1e-9 * static_cast<double>(FrameDelivery(world).timestamp_ns(exposed_s) -
                                                      FrameDelivery(usual).timestamp_ns(exposed_s));
    EXPECT_NEAR(wrong_s, exposed_s < 2 ? 0 : -0.3, 1e-8);
    EXPECT_EQ(FrameDelivery(world).arrival_ns(exposed_s),
              FrameDelivery(usual).arrival_ns(exposed_s));
  }
}

}  // namespace
}  // namespace handeye::simulator
