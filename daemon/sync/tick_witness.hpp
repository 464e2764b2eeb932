// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye {

/// A second witness of a device's clock: its frame counter. Both are the device's own, so no delay
/// on the way touches their relation: when the clock is stepped they part at once, when the network
/// stalls they do not.
///
/// The period of a tick is learnt from steps that agree, then kept as the average since. Numbers
/// wrap at 2^32 and may come out of order. Constant time and no allocation.
class TickWitness {
 public:
  /// So many steps of one period in a row make it known.
  static constexpr int kLearning = 5;

  /// `tolerance_s`: how far clock and counter may part before it is a step.
  explicit TickWitness(double tolerance_s) : tolerance_s_(tolerance_s) {}

  /// Takes the device's time (without midnight's fall) and its counter's number of one datum.
  void observe(double device_s, std::uint32_t tick);

  /// Whether it has anything to say: the period is known.
  bool knows() const { return learnt_ >= kLearning; }

  /// How far the clock has been stepped against the counter since the period was learnt, as the
  /// last datum shows it; 0: it was not.
  double stepped_s() const { return stepped_s_; }

  /// Forgets what it knows: the clock, the counter or the period has been found to have changed.
  void reset() { *this = TickWitness(tolerance_s_); }

 private:
  void learn(double device_s, std::uint32_t tick);
  void judge(double device_s, std::uint32_t tick);

  double tolerance_s_;
  int learnt_{-1};  ///< steps of one period in a row; -1: no datum yet
  double period_s_{0};
  double anchor_device_s_{0};  ///< the clock against the counter is a line through the anchor
  std::uint32_t anchor_tick_{0};
  std::uint32_t newest_tick_{0};
  double newest_device_s_{0};
  double stepped_s_{0};
};

}  // namespace handeye
