// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/handeye/judge.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/result.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// What a provisional answer rests on: the eye's poses as they stand, without a global adjustment.
struct ProvisionalSnapshot {
  std::vector<RegisteredFrame> frames;  ///< thinned
  PoseBuffer hand;
  PoseNoise noise;  ///< of the tracker
  ScaleMode scale{ScaleMode::kUnknown};
  WantedSigma wanted;
  bool lens_given{true};
  /// What the lens adds, as the last whole answer had it; zero where it was given; nothing: not
  /// known.
  std::optional<Matrix6d> lens_covariance;
};

/// The answer as it stands while collecting.
struct Provisional {
  std::int64_t frames{0};  ///< it rests on
  /// Nothing: none yet, none to be shown, or the time offset is not found yet.
  std::optional<HandEyeSolution> solution;
  double time_offset_s{0};  ///< meaningless without a sigma
  std::optional<double> time_offset_sigma_s;
  double time_offset_confidence{0};  ///< 0..1, as TimeOffset's
  /// Of hand_from_eye, widened by as much as two halves differ more than they claim. What an
  /// uncertain lens adds only a whole answer finds: until it has found a lens that was not given
  /// there is none, then it is added as it was there.
  std::optional<MethodSigma> sigma;
  /// The same without the lens's part, and widened only where chance does not explain the halves,
  /// for one step makes more of the images: a whole answer is worth trying when this is small
  /// enough. Nothing also where the hand contradicts the lens.
  std::optional<MethodSigma> sigma_beside_lens;
  std::optional<MissingMotion> missing;                 ///< nothing: not known yet
  Eigen::Vector3d turned_deg{Eigen::Vector3d::Zero()};  ///< rms about the camera's x, y, z
};

/// Pure: any thread. Some ten to a hundred milliseconds.
Provisional provisional(const ProvisionalSnapshot& snapshot);

}  // namespace handeye
