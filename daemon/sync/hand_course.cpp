// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/hand_course.hpp"

#include <Eigen/Cholesky>

namespace handeye {
namespace {

using Terms = Eigen::Vector3d;

Terms terms(double t_s) {
  return {1, t_s, t_s * t_s};
}

/// Whether one course runs through both.
bool joined(const HandSample& earlier, const HandSample& later, std::int64_t longest_gap_ns) {
  return earlier.tracked && earlier.clock_epoch == later.clock_epoch &&
         later.timestamp_ns - earlier.timestamp_ns <= longest_gap_ns;
}

}  // namespace

Vector6d hand_movement(const Pose& from, const Pose& to) {
  Vector6d movement;
  movement << log_so3(to.linear() * from.linear().transpose()),
      to.translation() - from.translation();
  return movement;
}

std::optional<HandCourse> HandCourse::as_of(const PoseBuffer& buffer, std::size_t newest,
                                            const HandCourseOptions& options) {
  HandCourse course;
  course.take(buffer, newest, options);
  if (course.size_ < options.least_samples) return std::nullopt;
  if (course.times_s_[course.size_ - 1] > -1e-9 * static_cast<double>(options.least_span_ns)) {
    return std::nullopt;
  }
  course.invert_normal_equations();
  return course;
}

void HandCourse::take(const PoseBuffer& buffer, std::size_t newest,
                      const HandCourseOptions& options) {
  if (newest >= buffer.size() || !buffer.at(newest).tracked) return;
  const std::int64_t newest_ns = buffer.at(newest).timestamp_ns;
  const std::int64_t longest_gap_ns = buffer.bridged_gap_ns() + options.late_ns;
  for (std::size_t i = newest + 1; i-- > 0 && size_ < kMostSamples;) {
    const HandSample& sample = buffer.at(i);
    const bool is_old = newest_ns - sample.timestamp_ns > options.window_ns;
    if (is_old && size_ >= options.least_samples) return;
    if (size_ > 0 && !joined(sample, *samples_[size_ - 1], longest_gap_ns)) return;
    samples_[size_] = &sample;
    times_s_[size_] = 1e-9 * static_cast<double>(sample.timestamp_ns - newest_ns);
    ++size_;
  }
}

void HandCourse::invert_normal_equations() {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < size_; ++i) {
    const Terms row = terms(times_s_[i]);
    normal += row * row.transpose();
  }
  inverse_ = normal.ldlt().solve(Eigen::Matrix3d::Identity());
}

HandCourseValue HandCourse::at(double ahead_s, const Matrix6d& given) const {
  const Terms value_row = inverse_ * terms(ahead_s);
  const Terms rate_row = inverse_ * Terms(0, 1, 2 * ahead_s);
  const Terms acceleration_row = inverse_ * Terms(0, 0, 2);
  HandCourseValue value;
  double weights_of_given = 0;
  double cubes = ahead_s * ahead_s * ahead_s;
  for (std::size_t i = 0; i < size_; ++i) {
    const Vector6d moved = hand_movement(newest().room_from_hand, samples_[i]->room_from_hand);
    const double t_s = times_s_[i];
    const Terms at = terms(t_s);
    const double weight = value_row.dot(at);
    value.moved += weight * moved;
    value.rate += rate_row.dot(at) * moved;
    value.acceleration += acceleration_row.dot(at) * moved;
    cubes -= weight * t_s * t_s * t_s;
    if (samples_[i]->covariance) {
      value.covariance += weight * weight * samples_[i]->covariance->cast<double>();
    } else {
      weights_of_given += weight * weight;
    }
  }
  value.covariance += weights_of_given * given;
  value.jerk_gain_s3 = cubes / 6;
  return value;
}

}  // namespace handeye
