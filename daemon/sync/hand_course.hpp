// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "daemon/geometry/pose.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// Which samples one course is fitted to.
struct HandCourseOptions {
  /// Samples that old count. Longer: less noise, but the hand's course bends; 0.15 s is the best or
  /// nearly so 20 to 60 ms ahead on simulated free-hand motion, on the same three times as fast,
  /// and on a camera that was really carried about by hand (shared data, streams/).
  /// A tracker below 30 Hz has fewer than `least_samples` in it, and gets the time that they take.
  std::int64_t window_ns{150'000'000};
  std::int64_t least_span_ns{50'000'000};
  std::size_t least_samples{5};
  /// A course runs through gaps that are longer by so much than those interpolated across: the
  /// steps of a 10 Hz tracker lie on both sides of that limit, which is 100 ms.
  std::int64_t late_ns{5'000'000};
};

/// What a course says of an instant. Six numbers: the turn against the newest sample as a rotation
/// vector in the room [rad], the way from there [mm].
struct HandCourseValue {
  Vector6d moved{Vector6d::Zero()};
  Vector6d rate{Vector6d::Zero()};          ///< per s
  Vector6d acceleration{Vector6d::Zero()};  ///< per s^2
  /// Of `moved`, from the samples' noise.
  Matrix6d covariance{Matrix6d::Zero()};
  /// What a constant jerk of 1 /s^3 in the samples and beyond adds to the truth, but not to
  /// `moved`: with weights w_i of the samples at t_i, (h^3 - sum w_i t_i^3) / 6 at h.
  double jerk_gain_s3{0};
};

/// The hand's way as of a sample of a buffer: rotation vector and origin with constant
/// acceleration, fitted by least squares to this sample and those just before it, as far as they
/// are tracked, of one epoch and without a gap. Borrows from the buffer. No allocation.
class HandCourse {
 public:
  /// `newest`: position in the buffer. Nothing where there is too little to go by.
  static std::optional<HandCourse> as_of(const PoseBuffer& buffer, std::size_t newest,
                                         const HandCourseOptions& options = {});

  /// `ahead_s`: after the newest sample. `given`: the covariance of a sample that brings none of
  /// its own.
  HandCourseValue at(double ahead_s, const Matrix6d& given) const;
  const HandSample& newest() const { return *samples_[0]; }

 private:
  static constexpr std::size_t kMostSamples = 48;  ///< 0.15 s at 300 Hz
  HandCourse() = default;
  void take(const PoseBuffer& buffer, std::size_t newest, const HandCourseOptions& options);
  void invert_normal_equations();

  std::size_t size_{0};
  std::array<const HandSample*, kMostSamples> samples_{};  ///< newest first
  std::array<double, kMostSamples> times_s_{};             ///< since the newest
  Eigen::Matrix3d inverse_{Eigen::Matrix3d::Zero()};       ///< of the normal equations of 1, t, t^2
};

/// The movement (w, dt) from one pose to another as HandCourseValue has it.
Vector6d hand_movement(const Pose& from, const Pose& to);

}  // namespace handeye
