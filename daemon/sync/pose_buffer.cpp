// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/pose_buffer.hpp"

#include <algorithm>
#include <cassert>

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
  if (size_ > 0 && sample.timestamp_ns <= at(size_ - 1).timestamp_ns) {
    ++out_of_order_;
    return;
  }
  if (size_ == ring_.size()) {
    first_ = (first_ + 1) % ring_.size();
    --size_;
    ++forgotten_;
  }
  ring_[(first_ + size_) % ring_.size()] = sample;
  ++size_;
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
  if (b.timestamp_ns - a.timestamp_ns > options_.max_gap_ns) {
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

/// Whether one may interpolate between this sample and the next.
bool PoseBuffer::joined(std::size_t index) const {
  const HandSample& a = at(index);
  const HandSample& b = at(index + 1);
  return a.tracked && b.tracked && b.timestamp_ns - a.timestamp_ns <= options_.max_gap_ns;
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
