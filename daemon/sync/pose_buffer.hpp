// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/pose.hpp"
#include "daemon/sync/clock_model.hpp"

namespace handeye {

/// The hand as the tracker saw it once.
struct HandSample {
  std::int64_t timestamp_ns{0};  ///< host CLOCK_MONOTONIC, after the clock model
  bool tracked{false};           ///< false: hidden; the pose is meaningless
  Pose room_from_hand{Pose::Identity()};
  /// As the tracker itself says (6dcov): of (w [rad], dt [mm]) in the room, R = Exp(w) R_measured,
  /// t = t_measured + dt.
  std::optional<Eigen::Matrix<float, 6, 6>> covariance;
  /// The clock model does not vouch for the time stamp (ClockReading); `tracked` is false, too.
  bool doubtful_time{false};
  /// Counts the clocks' jumps: samples of two epochs are not on one time line.
  std::int32_t clock_epoch{0};
  /// What the time stamp comes from; nothing: from no device's clock.
  std::optional<ClockMapping> clock_mapping;
};

/// Outcome of a look-up: ordinary results, not errors.
enum class LookupStatus {
  kOk,
  kEmpty,   ///< no samples at all
  kTooOld,  ///< before the oldest sample
  kTooNew,  ///< after the newest sample
  kGap,     ///< no samples for too long around it, or a clock jumped there
  kHidden,  ///< a neighbour was not tracked
};

struct HandLookup {
  LookupStatus status{LookupStatus::kEmpty};
  Pose room_from_hand{Pose::Identity()};  ///< only for kOk
  double fraction{0};                     ///< 0..1 between the two neighbours
  /// The earlier neighbour, counted in order of time from the first that was ever kept; the next
  /// one is the later neighbour. A late sample renumbers those after it: compare look-ups only when
  /// nothing was pushed between them.
  std::int64_t sample{0};
  /// Of one sample here, from both neighbours' own; nothing: they said none.
  std::optional<Matrix6d> sample_covariance;
  /// Angular velocity in the hand frame [rad/s] and velocity of the hand's origin in the room
  /// [mm/s], over up to two more samples on either side: between two samples of a 60 Hz tracker
  /// noise of 0.06 deg would make 5 deg/s.
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};
};

struct PoseBufferOptions {
  std::size_t capacity{8192};  ///< samples; the oldest go first (136 s at 60 Hz); at least 1
  std::int64_t max_gap_ns{100'000'000};  ///< never an interpolation across a longer gap
  /// Nor across one longer than this, unless the tracker itself is so slow that its neighbours are
  /// farther apart. A swing of 20 deg at 0.5 Hz leaves the straight line by 0.07 deg in 55 ms, in
  /// 100 ms by 0.25 deg, four times a tracker's noise. Two lost samples of a 60 Hz tracker fit in.
  std::int64_t accurate_gap_ns{55'000'000};
};

/// Ring of hand samples in time order; interpolates on SE(3) between neighbours, never across a
/// gap, an untracked sample or a clock's jump (docs/math.md section 9). Storage is allocated once.
/// Not synchronised: one owner.
class PoseBuffer {
 public:
  /// A late sample is looked for a place among so many of the newest.
  static constexpr std::size_t kReorderWindow = 8;
  /// Samples of one epoch that are nearer than this are one datagram that came twice.
  static constexpr std::int64_t kSameInstant_ns = 200'000;

  explicit PoseBuffer(const PoseBufferOptions& options = {});

  /// Takes a sample to its place in time. Dropped and counted: what comes too late for the reorder
  /// window, what does not come after the epoch before, and duplicates. Samples of doubtful time
  /// have no place and are not kept. Constant time.
  void push(const HandSample& sample);
  HandLookup lookup(std::int64_t timestamp_ns) const;
  void clear();

  std::size_t size() const { return size_; }
  const HandSample& at(std::size_t index) const;  ///< 0 is the oldest
  /// Of a sample as HandLookup counts them, which must still be there.
  std::size_t index_of(std::int64_t sample) const {
    return static_cast<std::size_t>(sample - forgotten_);
  }
  std::int64_t number_of(std::size_t index) const {
    return forgotten_ + static_cast<std::int64_t>(index);
  }
  /// Whether one may interpolate between this sample and the next.
  bool joined(std::size_t index) const;
  std::uint64_t out_of_order() const { return out_of_order_; }  ///< dropped
  std::uint64_t duplicates() const { return duplicates_; }      ///< dropped
  std::uint64_t reordered() const { return reordered_; }        ///< late, but in time to be kept
  /// The longest gap that is bridged: depends on the tracker's own period.
  std::int64_t bridged_gap_ns() const;

 private:
  HandSample& slot(std::size_t index) { return ring_[(first_ + index) % ring_.size()]; }
  void insert(std::size_t index, const HandSample& sample);
  void learn_period(std::int64_t interval_ns);
  bool apart(std::size_t index) const;
  void add_velocity(std::size_t before, HandLookup& found) const;

  PoseBufferOptions options_;
  std::vector<HandSample> ring_;
  std::size_t first_{0};
  std::size_t size_{0};
  std::int64_t forgotten_{0};  ///< samples that were kept before the oldest
  std::int64_t period_ns_{0};  ///< the tracker's usual one; 0: not known yet
  std::uint64_t out_of_order_{0};
  std::uint64_t duplicates_{0};
  std::uint64_t reordered_{0};
};

}  // namespace handeye
