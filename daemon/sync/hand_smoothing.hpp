// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/pose.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

struct HandSmoothingOptions {
  /// Samples so near an instant say where the hand was. One and a half periods of the frames: then
  /// all samples count about alike, where the straight lines between the two around each frame
  /// leave some out and count others nearly alone (25 Hz of 60 Hz: as if there were 0.63 of them).
  std::int64_t reach_ns{60'000'000};
  /// Samples farther than so many times the median from where their neighbours have the hand are
  /// not smoothed over: one that flies is left out, where several do the hand may really jump.
  double most_residual{5};
};

/// The hand at an instant, between samples.
struct SmoothedHand {
  Pose room_from_hand{Pose::Identity()};
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};  ///< in the hand frame [rad/s]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};          ///< of its origin, in the room [mm/s]
  std::int64_t sample{0};  ///< the first that has a share, counted as HandLookup::sample
  /// Of that sample and those that follow it: their errors, weighted so, are this one's.
  std::vector<double> shares;
  /// Of one sample here, from their own, weighted alike; nothing: one of them said none.
  std::optional<Matrix6d> sample_covariance;
};

/// The hand's way after the fact, with samples on both sides: cubics in time, of rotation vector
/// and origin, by least squares through the samples around an instant. Where too few are around, or
/// they do not lie on one, beside gaps and hidden stretches, it is PoseBuffer's straight line.
class HandSmoothing {
 public:
  /// Borrows `hand`, which must not change. Some microseconds a sample.
  explicit HandSmoothing(const PoseBuffer& hand, const HandSmoothingOptions& options = {});

  /// Nothing where PoseBuffer finds none.
  std::optional<SmoothedHand> at(std::int64_t timestamp_ns) const;

 private:
  enum class Kind : std::uint8_t { kSmooth, kFlies, kRough };
  /// The median distance from where the neighbours have a sample; 0: not known yet.
  struct Usual {
    double rotation_rad{0}, translation_mm{0};
  };

  std::optional<SmoothedHand> fit(std::int64_t timestamp_ns, std::size_t before,
                                  std::optional<std::size_t> without) const;
  bool near(std::size_t index, std::int64_t timestamp_ns) const;
  std::vector<double> excesses(Usual& usual) const;
  bool is_worst(std::size_t index, const std::vector<double>& excesses) const;
  void classify_samples();

  const PoseBuffer& hand_;
  HandSmoothingOptions options_;
  std::vector<Kind> kinds_;  ///< one a sample
};

}  // namespace handeye
