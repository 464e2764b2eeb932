// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/watch_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace handeye::test {
namespace {

constexpr double kTimeOffset_s = 0.020;
/// The tracker's samples go on beyond the frame for this long before the next frame comes.
constexpr double kAhead_s = 0.025;
constexpr int kPoints = 700;

CameraModel endoscope() {
  return {.width = 640,
          .height = 480,
          .fx = 560,
          .fy = 562,
          .cx = 322,
          .cy = 238,
          .distortion = {-0.25, 0.08, 0.0005, -0.0003, 0.0}};
}

Pose mounted() {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3({0.3, -0.5, 1.1});
  pose.translation() = Eigen::Vector3d(40.0, -25.0, 295.0);
  return pose;
}

std::int64_t ns(double time_s) {
  return static_cast<std::int64_t>(std::llround(1e9 * time_s));
}

}  // namespace

WatchScene::WatchScene(const WatchSceneOptions& options)
    : options_(options),
      random_(options.seed),
      motion_(options.motions, options.seed + 5000),
      true_hand_from_eye_(mounted()) {
  const auto drawn = [&](double sigma) -> Eigen::Vector3d {
    const double x = normal_(random_);
    const double y = normal_(random_);
    return sigma * Eigen::Vector3d(x, y, normal_(random_));
  };
  const double sigma_rad = rad_from_deg(options.calibration_sigma_deg);
  calibration_.hand_from_eye.linear() = exp_so3(drawn(sigma_rad)) * true_hand_from_eye_.linear();
  calibration_.hand_from_eye.translation() =
      true_hand_from_eye_.translation() + drawn(options.calibration_sigma_mm);
  calibration_.covariance.diagonal().head<3>().setConstant(sigma_rad * sigma_rad);
  calibration_.covariance.diagonal().tail<3>().setConstant(
      std::pow(options.calibration_sigma_mm, 2));
  calibration_.time_offset_s = kTimeOffset_s + 0.0003 * normal_(random_);
  calibration_.camera = endoscope();
  calibration_.hand_noise = {rad_from_deg(options.hand_rotation_deg), options.hand_translation_mm};
  calibration_.image_noise_px = options.noise_px;
  for (double& phase : slow_phase_) phase = 2.0 * kPi * uniform_(random_);
  build_scene();
}

void WatchScene::build_scene() {
  points_.assign(kPoints, {});
  const double phase = 6.0 * uniform_(random_);
  const double relief_mm = 12.0 * uniform_(random_);
  const double distance_mm = 60.0 + 40.0 * uniform_(random_);
  for (Point& point : points_) {
    const double x = 240.0 * uniform_(random_) - 120.0;
    const double y = 240.0 * uniform_(random_) - 120.0;
    point.room = {x, y, distance_mm + relief_mm * std::sin(0.11 * x + phase) * std::cos(0.09 * y)};
  }
}

/// About every half minute something gets in the way.
void WatchScene::disturb() {
  const double chance = 1.0 / (30.0 * options_.rate_hz);
  if (uniform_(random_) < chance) hidden_until_s_ = time_s_ + 2.0 * uniform_(random_);
  if (uniform_(random_) < chance) covered_until_s_ = time_s_ + 1.5 * uniform_(random_);
  if (uniform_(random_) < chance) build_scene();
}

Pose WatchScene::hand_from_eye() const {
  Pose now = true_hand_from_eye_;
  if (options_.turned_at_s < 0 || time_s_ < options_.turned_at_s) return now;
  const double share = std::min(1.0, (time_s_ - options_.turned_at_s) / options_.turning_s);
  now.translation() += now.linear() * (share * options_.shift_mm);
  now.linear() = now.linear() * exp_so3(share * options_.turn_deg * (kPi / 180.0));
  return now;
}

bool WatchScene::slides(std::int64_t feature_id) const {
  return std::ranges::any_of(
      points_, [&](const Point& point) { return point.feature_id == feature_id && point.sliding; });
}

HandSample WatchScene::sample_hand(double time_s, const Pose& room_from_hand) {
  HandSample sample;
  sample.timestamp_ns = ns(time_s - kTimeOffset_s);
  sample.tracked = time_s >= hidden_until_s_;
  const auto drawn = [&](double white, double slow, Eigen::Index first) -> Eigen::Vector3d {
    Eigen::Vector3d error;
    for (Eigen::Index i = 0; i < 3; ++i) {
      // Wrong from place to place: by the direction that the body is seen from.
      const double where =
          4.0 * room_from_hand.linear()(i, (i + 1) % 3) + 0.03 * room_from_hand.translation()(i);
      error(i) = white * normal_(random_) +
                 slow * std::sqrt(2.0) * std::sin(2.0 * kPi * where + slow_phase_(first + i));
    }
    return error;
  };
  sample.room_from_hand = room_from_hand;
  sample.room_from_hand.linear() = exp_so3(drawn(rad_from_deg(options_.hand_rotation_deg),
                                                 rad_from_deg(options_.hand_slow_deg), 0)) *
                                   room_from_hand.linear();
  sample.room_from_hand.translation() +=
      drawn(options_.hand_translation_mm, options_.hand_slow_mm, 3);
  return sample;
}

void WatchScene::look(const Pose& room_from_eye) {
  frame_.observations.clear();
  const Pose eye_from_room = room_from_eye.inverse();
  const bool covered = time_s_ < covered_until_s_;
  int free = options_.max_features;
  for (const bool known : {true, false}) {
    for (Point& point : points_) {
      if ((point.feature_id >= 0) != known) continue;
      const Eigen::Vector3d eye = eye_from_room * point.room;
      const bool before = !covered && eye.z() > 5 && eye.head<2>().norm() < eye.z();
      const Eigen::Vector2d pixel = before ? project<double>(calibration_.camera, eye)
                                           : Eigen::Vector2d(Eigen::Vector2d::Constant(-1));
      const bool visible =
          before && pixel.x() > 5 && pixel.y() > 5 && pixel.x() < 634 && pixel.y() < 474;
      if (known && (!visible || uniform_(random_) < options_.death_rate)) {
        point = {.room = point.room};
        continue;
      }
      if (!visible || (!known && free <= 0)) continue;
      if (!known) {
        point.feature_id = next_feature_++;
        point.sliding = uniform_(random_) < options_.sliding;
        const double x = 2.0 * uniform_(random_) - 1.0;
        point.step_px = {x, 2.0 * uniform_(random_) - 1.0};
      }
      --free;
      const auto drawn = [&](double sigma) -> Eigen::Vector2d {
        const double x = normal_(random_);
        return {sigma * x, sigma * normal_(random_)};
      };
      point.off_px += drawn(options_.drift_px);
      if (point.sliding) point.off_px += point.step_px;
      frame_.observations.push_back(
          {point.feature_id, pixel + point.off_px + drawn(options_.noise_px)});
    }
  }
  std::ranges::sort(frame_.observations, {}, &Observation::feature_id);
}

std::int64_t WatchScene::next(CalibrationWatch& watch) {
  return next({.add_hand = [&](const HandSample& sample) { watch.add_hand(sample); },
               .add_frame = [&](const TrackedFrame& frame) { watch.add_frame(frame); }});
}

std::int64_t WatchScene::next(const WatchSink& sink) {
  time_s_ += 1.0 / options_.rate_hz;
  if (options_.disturbed) disturb();
  const Pose hand_from_camera = true_hand_from_eye_.inverse();
  for (; next_sample_s_ < time_s_; next_sample_s_ += 1.0 / options_.tracker_hz) {
    motion_.advance(next_sample_s_);
    samples_.push_back(sample_hand(next_sample_s_, motion_.room_from_eye() * hand_from_camera));
  }
  motion_.advance(time_s_);
  look(motion_.room_from_eye() * hand_from_camera * hand_from_eye());
  ++frame_.index;
  frame_.timestamp_ns = ns(time_s_);
  if (options_.turned_at_s >= 0 && time_s_ > options_.turned_at_s + options_.turning_s &&
      time_s_ > hidden_until_s_ && time_s_ > covered_until_s_ &&
      (motion_.speed_deg_s() > 5.0 || motion_.speed_mm_s() > 5.0)) {
    moved_since_turn_s_ += 1.0 / options_.rate_hz;
  }
  for (const HandSample& sample : std::exchange(samples_, {})) sink.add_hand(sample);
  sink.add_frame(frame_);
  for (; next_sample_s_ < time_s_ + kAhead_s; next_sample_s_ += 1.0 / options_.tracker_hz) {
    motion_.advance(next_sample_s_);
    sink.add_hand(sample_hand(next_sample_s_, motion_.room_from_eye() * hand_from_camera));
  }
  return frame_.timestamp_ns;
}

}  // namespace handeye::test
