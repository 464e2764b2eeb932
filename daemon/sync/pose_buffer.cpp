// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/pose_buffer.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>

namespace handeye {
namespace {

/// Samples on either side of the two neighbours that the velocity is taken over.
constexpr std::size_t kVelocityReach = 2;

}  // namespace

PoseBuffer::PoseBuffer(const PoseBufferOptions& options) : options_(options) {
  options_.capacity = std::max<std::size_t>(options_.capacity, 1);
  ring_.resize(options_.capacity);
}

void PoseBuffer::push(const HandSample& sample) {
  if (sample.doubtful_time) return;
  const std::size_t oldest = size_ - std::min(size_, kReorderWindow);
  std::size_t place = size_;
  while (place > oldest && at(place - 1).timestamp_ns >= sample.timestamp_ns) --place;
  const auto is_other_epoch = [&](std::size_t index) {
    return at(index).clock_epoch != sample.clock_epoch;
  };
  const auto is_same = [&](std::size_t index) {
    return std::abs(at(index).timestamp_ns - sample.timestamp_ns) < kSameInstant_ns;
  };
  const bool is_late = place < size_;
  if (is_late && (is_other_epoch(size_ - 1) || is_other_epoch(place))) {
    ++out_of_order_;
  } else if ((is_late && is_same(place)) || (place > 0 && is_same(place - 1))) {
    ++duplicates_;
  } else if (is_late && (place == oldest || is_other_epoch(place - 1))) {
    ++out_of_order_;
  } else {
    if (is_late)
      ++reordered_;
    else if (size_ > 0)
      learn_period(sample.timestamp_ns - at(size_ - 1).timestamp_ns);
    insert(place, sample);
  }
}

void PoseBuffer::insert(std::size_t index, const HandSample& sample) {
  if (size_ == ring_.size()) {
    if (index == 0) return;  // older than all of a full ring
    first_ = (first_ + 1) % ring_.size();
    --size_;
    --index;
    ++forgotten_;
  }
  for (std::size_t i = size_; i > index; --i) slot(i) = slot(i - 1);
  slot(index) = sample;
  ++size_;
}

/// Follows the median of the intervals: a step of a fixed ratio up or down.
void PoseBuffer::learn_period(std::int64_t interval_ns) {
  constexpr std::int64_t kSteps = 50;
  if (period_ns_ == 0) period_ns_ = std::min(interval_ns, options_.max_gap_ns);
  const std::int64_t step_ns = period_ns_ / kSteps;
  period_ns_ += interval_ns > period_ns_ ? step_ns : -step_ns;
}

std::int64_t PoseBuffer::bridged_gap_ns() const {
  const std::int64_t wanted_ns = std::max(options_.accurate_gap_ns, period_ns_ + period_ns_ / 2);
  return std::min(options_.max_gap_ns, wanted_ns);
}

void PoseBuffer::clear() {
  forgotten_ += static_cast<std::int64_t>(size_);
  first_ = 0;
  size_ = 0;
}

const HandSample& PoseBuffer::at(std::size_t index) const {
  assert(index < size_);
  return ring_[(first_ + index) % ring_.size()];
}

HandLookup PoseBuffer::lookup(std::int64_t timestamp_ns) const {
  HandLookup found;
  if (size_ == 0) return found;
  if (timestamp_ns < at(0).timestamp_ns) {
    found.status = LookupStatus::kTooOld;
    return found;
  }
  if (timestamp_ns > at(size_ - 1).timestamp_ns) {
    found.status = LookupStatus::kTooNew;
    return found;
  }

  // The last sample that is not newer than the time asked for.
  std::size_t before = 0;
  std::size_t end = size_;
  while (end - before > 1) {
    const std::size_t middle = before + (end - before) / 2;
    (at(middle).timestamp_ns <= timestamp_ns ? before : end) = middle;
  }
  const HandSample& a = at(before);
  if (a.timestamp_ns == timestamp_ns) {
    found.status = a.tracked ? LookupStatus::kOk : LookupStatus::kHidden;
    found.room_from_hand = a.room_from_hand;
    found.sample = forgotten_ + static_cast<std::int64_t>(before);
    if (a.covariance) found.sample_covariance = a.covariance->cast<double>();
    if (a.tracked) add_velocity(before, found);
    return found;
  }
  const HandSample& b = at(before + 1);
  if (apart(before)) {
    found.status = LookupStatus::kGap;
    return found;
  }
  if (!a.tracked || !b.tracked) {
    found.status = LookupStatus::kHidden;
    return found;
  }
  found.status = LookupStatus::kOk;
  found.fraction = static_cast<double>(timestamp_ns - a.timestamp_ns) /
                   static_cast<double>(b.timestamp_ns - a.timestamp_ns);
  found.sample = forgotten_ + static_cast<std::int64_t>(before);
  if (a.covariance && b.covariance) {
    found.sample_covariance = 0.5 * (*a.covariance + *b.covariance).cast<double>();
  }
  found.room_from_hand = interpolate(a.room_from_hand, b.room_from_hand, found.fraction);
  add_velocity(before, found);
  return found;
}

/// Whether too much time lies between this sample and the next, or a clock jumped between them.
bool PoseBuffer::apart(std::size_t index) const {
  const HandSample& a = at(index);
  const HandSample& b = at(index + 1);
  return a.clock_epoch != b.clock_epoch || b.timestamp_ns - a.timestamp_ns > bridged_gap_ns();
}

bool PoseBuffer::joined(std::size_t index) const {
  return at(index).tracked && at(index + 1).tracked && !apart(index);
}

void PoseBuffer::add_velocity(std::size_t before, HandLookup& found) const {
  std::size_t low = before;
  std::size_t high = before;
  while (low > 0 && before - low < kVelocityReach && joined(low - 1)) --low;
  while (high + 1 < size_ && high - before < kVelocityReach + 1 && joined(high)) ++high;
  if (low == high) return;
  const HandSample& a = at(low);
  const HandSample& b = at(high);
  const double passed_s = static_cast<double>(b.timestamp_ns - a.timestamp_ns) * 1e-9;
  const Eigen::Matrix3d turn = a.room_from_hand.linear().transpose() * b.room_from_hand.linear();
  found.angular_velocity = log_so3(turn) / passed_s;
  found.velocity = (b.room_from_hand.translation() - a.room_from_hand.translation()) / passed_s;
}

}  // namespace handeye
