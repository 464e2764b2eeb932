// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// The hand as the tracker saw it once.
struct HandSample {
  std::int64_t timestamp_ns{0};  ///< host CLOCK_MONOTONIC, after the clock model
  bool tracked{false};           ///< false: hidden; the pose is meaningless
  Pose room_from_hand{Pose::Identity()};
  /// As the tracker itself says (6dcov): of (w [rad], dt [mm]) in the room, R = Exp(w) R_measured,
  /// t = t_measured + dt.
  std::optional<Eigen::Matrix<float, 6, 6>> covariance;
};

/// Outcome of a look-up: ordinary results, not errors.
enum class LookupStatus {
  kOk,
  kEmpty,   ///< no samples at all
  kTooOld,  ///< before the oldest sample
  kTooNew,  ///< after the newest sample
  kGap,     ///< no samples for longer than max_gap_ns around it
  kHidden,  ///< a neighbour was not tracked
};

struct HandLookup {
  LookupStatus status{LookupStatus::kEmpty};
  Pose room_from_hand{Pose::Identity()};  ///< only for kOk
  double fraction{0};                     ///< 0..1 between the two neighbours
  std::int64_t sample{0};  ///< the earlier neighbour, counted from the first that was ever pushed
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
  std::int64_t max_gap_ns{100'000'000};  ///< no interpolation across a longer gap
};

/// Ring of hand samples in time order; interpolates on SE(3) between neighbours, never across a gap
/// or an untracked sample (docs/math.md section 9). Storage is allocated once. Not synchronised:
/// one owner.
class PoseBuffer {
 public:
  explicit PoseBuffer(const PoseBufferOptions& options = {});

  /// Samples that are not newer than the last one are dropped and counted.
  void push(const HandSample& sample);
  HandLookup lookup(std::int64_t timestamp_ns) const;
  void clear();

  std::size_t size() const { return size_; }
  const HandSample& at(std::size_t index) const;  ///< 0 is the oldest
  std::uint64_t out_of_order() const { return out_of_order_; }

 private:
  bool joined(std::size_t index) const;
  void add_velocity(std::size_t before, HandLookup& found) const;

  PoseBufferOptions options_;
  std::vector<HandSample> ring_;
  std::size_t first_{0};
  std::size_t size_{0};
  std::int64_t forgotten_{0};  ///< samples that were pushed before the oldest
  std::uint64_t out_of_order_{0};
};

}  // namespace handeye
