// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/tick_witness.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

// Steps of one period differ by the stamps' noise.
constexpr double kSamePeriod = 0.25;
// Counter and clock hang on one crystal, or on two whose temperatures change.
constexpr double kPeriodTolerance = 1e-4;
// The average over so many ticks is precise, and follows a crystal that warms up.
constexpr int kAnchorTicks = 4096;
// A number that goes back further than this has begun anew.
constexpr double kLateTicks = 160;

double ticks_between(std::uint32_t from, std::uint32_t to) {
  return static_cast<double>(static_cast<std::int32_t>(to - from));
}

}  // namespace

void TickWitness::observe(double device_s, std::uint32_t tick) {
  knows() ? judge(device_s, tick) : learn(device_s, tick);
}

void TickWitness::learn(double device_s, std::uint32_t tick) {
  const double ticks = ticks_between(newest_tick_, tick);
  const double passed_s = device_s - newest_device_s_;
  if (learnt_ >= 0 && ticks > 0 && passed_s > 0) {
    const double period_s = passed_s / ticks;
    if (learnt_ > 0 && std::abs(period_s - period_s_) < kSamePeriod * period_s_) {
      ++learnt_;
      period_s_ = (device_s - anchor_device_s_) / ticks_between(anchor_tick_, tick);
    } else {
      learnt_ = 1;
      period_s_ = period_s;
      anchor_device_s_ = newest_device_s_;
      anchor_tick_ = newest_tick_;
    }
  } else if (learnt_ >= 0 && ticks <= 0 && ticks > -kLateTicks) {
    return;  // overtaken, or come twice
  } else {
    learnt_ = 0;
  }
  newest_tick_ = tick;
  newest_device_s_ = device_s;
}

void TickWitness::judge(double device_s, std::uint32_t tick) {
  const double ticks = ticks_between(anchor_tick_, tick);
  const double learnt_over = std::max(1.0, ticks_between(anchor_tick_, newest_tick_));
  const double beyond = std::max(0.0, ticks - learnt_over);
  const double tolerance_s =
      tolerance_s_ + beyond * std::max(tolerance_s_ / learnt_over, kPeriodTolerance * period_s_);
  const double error_s = device_s - (anchor_device_s_ + ticks * period_s_);
  stepped_s_ = std::abs(error_s) > tolerance_s ? error_s : 0;
  if (stepped_s_ != 0 || ticks <= learnt_over) return;
  newest_tick_ = tick;
  period_s_ = (device_s - anchor_device_s_) / ticks;
  if (ticks <= kAnchorTicks) return;
  anchor_tick_ = tick - kAnchorTicks / 2;
  anchor_device_s_ = device_s - period_s_ * (kAnchorTicks / 2);
}

}  // namespace handeye
