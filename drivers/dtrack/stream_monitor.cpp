// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/stream_monitor.hpp"

#include <algorithm>

namespace handeye::dtrack {

StreamEvent StreamMonitor::observe(std::uint32_t frame_number) {
  if (!started_) {
    started_ = true;
    newest_ = frame_number;
    return StreamEvent::kFirst;
  }
  const std::uint32_t step = frame_number - newest_;
  if (step == 0) {
    ++repeated_;
    return StreamEvent::kRepeated;
  }
  if (static_cast<std::int32_t>(step) < 0) return step_back(frame_number);
  newest_ = frame_number;
  return step_forward(step);
}

StreamEvent StreamMonitor::step_back(std::uint32_t frame_number) {
  const std::uint32_t back = newest_ - frame_number;
  const bool near = back <= kLateSteps * std::max(divisor_, 1U);
  if (near && late_in_a_row_ + 1 < kRestartFrames) {
    ++late_in_a_row_;
    ++late_;
    if (lost_ > 0) {  // it was counted as lost when a later one came
      --lost_;
      ++found_in_a_row_;
    }
    return StreamEvent::kLate;
  }
  ++restarts_;
  if (near) {  // those before it were not late either
    late_ -= static_cast<std::uint64_t>(late_in_a_row_);
    lost_ += found_in_a_row_;
  }
  late_in_a_row_ = 0;
  found_in_a_row_ = 0;
  same_steps_ = 0;
  newest_ = frame_number;
  return StreamEvent::kRestarted;
}

StreamEvent StreamMonitor::step_forward(std::uint32_t step) {
  late_in_a_row_ = 0;
  found_in_a_row_ = 0;
  learn_divisor(step);
  const std::uint32_t missing = (step - 1) / divisor_;
  lost_ += missing;
  return missing == 0 ? StreamEvent::kNext : StreamEvent::kGap;
}

void StreamMonitor::learn_divisor(std::uint32_t step) {
  same_steps_ = step == last_step_ ? same_steps_ + 1 : 1;
  last_step_ = step;
  if (divisor_ == 0 || step < divisor_) {
    divisor_ = std::min(step, kMaxDivisor);
  } else if (step > divisor_ && step <= kMaxDivisor && same_steps_ >= kNewDivisorSteps) {
    const std::uint64_t wrongly_lost =
        std::uint64_t{(step - 1) / divisor_} * (kNewDivisorSteps - 1);
    lost_ -= std::min(lost_, wrongly_lost);
    divisor_ = step;
  }
}

}  // namespace handeye::dtrack
