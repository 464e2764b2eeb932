// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/hand_prediction.hpp"

#include <algorithm>

namespace handeye {
namespace {

// Predictions that overlap miss alike, and so do axes that a hand moves along together: of so many
// predictions one is an independent figure.
constexpr double kMissAlike = 2;

/// Mean square jerk per axis of the turn [(rad/s^3)^2] and of the way [(mm/s^3)^2].
struct JerkVariance {
  double turn{0};
  double way{0};
};

double seconds(std::int64_t duration_ns) {
  return 1e-9 * static_cast<double>(duration_ns);
}

/// The jerk of a sway through this velocity and acceleration is omega sqrt(a^2 + omega^2 v^2) at
/// most.
JerkVariance jerk_of_sway(const HandCourseValue& now, double sway_rad_per_s) {
  const double square = sway_rad_per_s * sway_rad_per_s;
  const auto of = [&](const auto& rate, const auto& acceleration) {
    return square * (acceleration.squaredNorm() + square * rate.squaredNorm()) / 3;
  };
  return {of(now.rate.head<3>(), now.acceleration.head<3>()),
          of(now.rate.tail<3>(), now.acceleration.tail<3>())};
}

/// What former samples differed by from their predictions, beyond what noise explains.
class Hindsight {
 public:
  void add(const HandCourseValue& predicted, const Vector6d& moved, const Matrix6d& sample) {
    const Vector6d error = moved - predicted.moved;
    const Vector6d noise = (predicted.covariance + sample).diagonal();
    turn_ += (error.head<3>().squaredNorm() - noise.head<3>().sum()) / 3;
    way_ += (error.tail<3>().squaredNorm() - noise.tail<3>().sum()) / 3;
    gain_ += predicted.jerk_gain_s3 * predicted.jerk_gain_s3;
    ++count_;
  }
  int count() const { return count_; }
  /// What is divided by the mean square of n figures is n / (n - 2) times as large on average as
  /// what is divided by the true one.
  JerkVariance jerk() const {
    const double figures = count_ / kMissAlike;
    const double factor = figures / (figures - 2) / gain_;
    return {factor * std::max(turn_, 0.0), factor * std::max(way_, 0.0)};
  }

 private:
  double turn_{0};
  double way_{0};
  double gain_{0};
  int count_{0};
};

/// Predicts the samples of the last while from those at least `ahead_ns` before them.
Hindsight look_back(const PoseBuffer& buffer, std::int64_t ahead_ns, const Matrix6d& given,
                    const HandPredictionOptions& options) {
  Hindsight hindsight;
  const std::size_t newest = buffer.size() - 1;
  std::size_t from = newest;
  for (std::size_t to = newest; to > 0; --to) {
    const HandSample& sample = buffer.at(to);
    const std::int64_t ago_ns = buffer.at(newest).timestamp_ns - sample.timestamp_ns;
    const bool is_enough = hindsight.count() >= options.least_hindsights;
    if (ago_ns > (is_enough ? options.hindsight_ns : options.longest_hindsight_ns)) break;
    from = std::min(from, to - 1);
    while (from > 0 && sample.timestamp_ns - buffer.at(from).timestamp_ns < ahead_ns) --from;
    const HandSample& last = buffer.at(from);
    if (!sample.tracked || sample.clock_epoch != last.clock_epoch) continue;
    const auto course = HandCourse::as_of(buffer, from, options.course);
    if (!course) continue;
    const double ahead_s = seconds(sample.timestamp_ns - last.timestamp_ns);
    const Matrix6d own = sample.covariance ? Matrix6d(sample.covariance->cast<double>()) : given;
    hindsight.add(course->at(ahead_s, given),
                  hand_movement(last.room_from_hand, sample.room_from_hand), own);
  }
  return hindsight;
}

/// How much jerk to reckon with.
JerkVariance unmodelled_jerk(const PoseBuffer& buffer, const HandCourseValue& now, double ahead_s,
                             const Matrix6d& given, const HandPredictionOptions& options) {
  const auto ahead_ns = static_cast<std::int64_t>(1e9 * ahead_s);
  const Hindsight hindsight = look_back(buffer, ahead_ns, given, options);
  if (hindsight.count() < options.least_hindsights) {
    return jerk_of_sway(now, options.shaky_sway_rad_per_s);
  }
  const JerkVariance seen = hindsight.jerk();
  const JerkVariance least = jerk_of_sway(now, options.sway_rad_per_s);
  return {std::max(seen.turn, least.turn), std::max(seen.way, least.way)};
}

}  // namespace

Matrix6d hand_sample_covariance(const HandSampleNoise& noise) {
  Vector6d variance;
  variance.head<3>().setConstant(noise.rotation_rad * noise.rotation_rad);
  variance.tail<3>().setConstant(noise.translation_mm * noise.translation_mm);
  return variance.asDiagonal();
}

HandEstimate interpolated_hand(const HandLookup& found, const HandSampleNoise& noise) {
  HandEstimate hand;
  hand.room_from_hand = found.room_from_hand;
  const double a = found.fraction;
  hand.covariance =
      ((1 - a) * (1 - a) + a * a) * found.sample_covariance.value_or(hand_sample_covariance(noise));
  hand.angular_velocity = found.room_from_hand.linear() * found.angular_velocity;
  hand.velocity = found.velocity;
  return hand;
}

std::optional<HandEstimate> predict_hand(const PoseBuffer& samples, std::int64_t timestamp_ns,
                                         const HandSampleNoise& noise,
                                         const HandPredictionOptions& options) {
  if (samples.size() == 0) return std::nullopt;
  const auto course = HandCourse::as_of(samples, samples.size() - 1, options.course);
  if (!course) return std::nullopt;
  const Pose& newest = course->newest().room_from_hand;
  const double ahead_s = seconds(timestamp_ns - course->newest().timestamp_ns);
  const Matrix6d given = hand_sample_covariance(noise);
  const HandCourseValue value = course->at(ahead_s, given);
  const JerkVariance jerk = unmodelled_jerk(samples, value, ahead_s, given, options);
  const double gain_square = value.jerk_gain_s3 * value.jerk_gain_s3;

  HandEstimate hand;
  hand.room_from_hand.linear() = exp_so3(value.moved.head<3>()) * newest.linear();
  hand.room_from_hand.translation() = newest.translation() + value.moved.tail<3>();
  hand.angular_velocity = value.rate.head<3>();
  hand.velocity = value.rate.tail<3>();
  hand.covariance = value.covariance;
  hand.covariance.diagonal().head<3>().array() += gain_square * jerk.turn;
  hand.covariance.diagonal().tail<3>().array() += gain_square * jerk.way;
  hand.predicted_s = ahead_s;
  return hand;
}

}  // namespace handeye
