// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye::dtrack {

/// What a frame number tells about the stream.
enum class StreamEvent : std::uint8_t {
  kFirst,      ///< nothing to compare with
  kNext,       ///< the one that was due
  kGap,        ///< some before it are missing
  kRepeated,   ///< the same number again
  kLate,       ///< overtaken by later ones on the way: do not let it overwrite them
  kRestarted,  ///< the controller counts anew
};

/// Follows `fr` from datagram to datagram and counts what was lost on the way.
///
/// The controller sends every n-th frame (its output divisor, 1..10), so `fr` steps by n. The
/// divisor is the smallest step seen; when the operator raises it, a larger step that comes
/// kNewDivisorSteps times in a row is taken for the new one and what had been counted as lost in
/// these steps is taken back. Before the second step it is not known, so a gap there goes unseen.
///
/// A number that goes back by up to kLateSteps steps is a late datagram; if kRestartFrames in a row
/// would be late, or it goes back further, the count has restarted. Numbers wrap at 2^32.
class StreamMonitor {
 public:
  static constexpr std::uint32_t kMaxDivisor = 10;
  static constexpr int kNewDivisorSteps = 10;
  static constexpr int kLateSteps = 16;
  static constexpr int kRestartFrames = 4;

  StreamEvent observe(std::uint32_t frame_number);

  /// Frames between the first number and the last, in steps of the divisor, that never came.
  std::uint64_t lost() const { return lost_; }
  std::uint64_t repeated() const { return repeated_; }
  std::uint64_t late() const { return late_; }
  std::uint64_t restarts() const { return restarts_; }

  /// 0 before two frames have come.
  std::uint32_t divisor() const { return divisor_; }

 private:
  StreamEvent step_back(std::uint32_t frame_number);
  StreamEvent step_forward(std::uint32_t step);
  void learn_divisor(std::uint32_t step);

  bool started_{false};
  std::uint32_t newest_{0};
  std::uint32_t divisor_{0};
  std::uint32_t last_step_{0};
  int same_steps_{0};  ///< so many times in a row the step was last_step_
  int late_in_a_row_{0};
  std::uint64_t found_in_a_row_{0};  ///< of these, taken back from lost_
  std::uint64_t lost_{0};
  std::uint64_t repeated_{0};
  std::uint64_t late_{0};
  std::uint64_t restarts_{0};
};

}  // namespace handeye::dtrack
