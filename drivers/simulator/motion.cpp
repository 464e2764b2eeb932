// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/motion.hpp"

#include <cmath>
#include <utility>

namespace handeye::simulator {
namespace {

constexpr std::array<std::pair<MotionKind, std::string_view>, 9> kNames{{
    {MotionKind::kFree, "free"},
    {MotionKind::kTranslation, "translation"},
    {MotionKind::kRotation, "rotation"},
    {MotionKind::kSingleAxis, "single-axis"},
    {MotionKind::kPivot, "pivot"},
    {MotionKind::kStatic, "static"},
    {MotionKind::kWobble, "wobble"},
    {MotionKind::kPivotSlide, "pivot-slide"},
    {MotionKind::kRollOnly, "roll-only"},
}};

/// The eye looks straight down on the surface: x stays, y and z turn over.
Eigen::Matrix3d straight_down() {
  return Eigen::Vector3d(1, -1, -1).asDiagonal();
}

}  // namespace

std::string_view motion_name(MotionKind kind) {
  for (const auto& [known, name] : kNames) {
    if (known == kind) return name;
  }
  return {};
}

std::optional<MotionKind> motion_from_name(std::string_view name) {
  for (const auto& [kind, known] : kNames) {
    if (known == name) return kind;
  }
  return std::nullopt;
}

Wander::Wander(RandomStream& random)
    : angular_frequency_(2 * kPi * random.uniform(0.13, 0.19)),
      phase_rad_(random.uniform(0, 2 * kPi)) {
  for (Sway& sway : sways_) {
    sway.angular_frequency = 2 * kPi * random.uniform(0.03, 0.11);
    sway.phase_rad = random.uniform(0, 2 * kPi);
    // Together the sways change the speed by half of the mean at most.
    sway.amplitude_rad = 0.5 * angular_frequency_ / (3.0 * sway.angular_frequency);
  }
}

double Wander::at(double time_s) const {
  double angle = angular_frequency_ * time_s + phase_rad_;
  for (const Sway& sway : sways_) {
    angle += sway.amplitude_rad * std::sin(sway.angular_frequency * time_s + sway.phase_rad);
  }
  return std::sin(angle);
}

Motion::Motion(std::uint64_t seed, Eigen::Vector3d target, const MotionOptions& options)
    : options_(options), target_(std::move(target)) {
  RandomStream random(seed, Purpose::kMotion);
  for (int axis = 0; axis < 3; ++axis) turns_.emplace_back(random);
  for (int axis = 0; axis < 3; ++axis) shifts_.emplace_back(random);
  single_axis_ = random.direction();
}

Pose Motion::surface_from_eye(double time_s) const {
  Pose surface_from_eye = Pose::Identity();
  surface_from_eye.linear() = straight_down() * exp_so3(turn(time_s));
  const Eigen::Vector3d view_axis = surface_from_eye.linear().col(2);
  const Eigen::Vector3d home = target_ + Eigen::Vector3d(0, 0, options_.view_distance_mm);
  switch (options_.kind) {
    case MotionKind::kFree:
    case MotionKind::kSingleAxis:
    case MotionKind::kTranslation:
      // Circles the target, so that it stays in view.
      surface_from_eye.translation() =
          target_ - options_.view_distance_mm * view_axis + shift(time_s);
      break;
    case MotionKind::kPivot:
    case MotionKind::kPivotSlide: {
      const Eigen::Vector3d pivot = home + Eigen::Vector3d(0, 0, options_.pivot_behind_eye_mm);
      surface_from_eye.translation() =
          pivot - surface_from_eye.linear() * pivot_in_eye() + slide_mm(time_s) * view_axis;
      break;
    }
    case MotionKind::kWobble:
      surface_from_eye.translation() = home + shift(time_s);
      break;
    case MotionKind::kRotation:
    case MotionKind::kRollOnly:
    case MotionKind::kStatic:
      surface_from_eye.translation() = home;
      break;
  }
  return surface_from_eye;
}

Eigen::Vector3d Motion::turn(double time_s) const {
  const double largest = rad_from_deg(options_.rotation_deg);
  const Eigen::Vector3d wander(turns_[0].at(time_s), turns_[1].at(time_s), turns_[2].at(time_s));
  switch (options_.kind) {
    case MotionKind::kFree:
    case MotionKind::kRotation:
      return largest * wander;
    case MotionKind::kSingleAxis:
      return largest * wander.x() * single_axis_;
    case MotionKind::kRollOnly:
      return {0, 0, largest * wander.z()};
    case MotionKind::kWobble:
      return rad_from_deg(options_.wobble_deg) * wander;
    case MotionKind::kPivot:
    case MotionKind::kPivotSlide: {
      const double tilt = rad_from_deg(options_.pivot_tilt_deg);
      return Eigen::Vector3d(tilt, tilt, largest).cwiseProduct(wander);
    }
    case MotionKind::kTranslation:
    case MotionKind::kStatic:
      break;
  }
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d Motion::shift(double time_s) const {
  const double largest =
      options_.kind == MotionKind::kWobble ? options_.wobble_mm : options_.shift_mm;
  return largest *
         Eigen::Vector3d(shifts_[0].at(time_s), shifts_[1].at(time_s), shifts_[2].at(time_s));
}

double Motion::slide_mm(double time_s) const {
  return options_.kind == MotionKind::kPivotSlide ? options_.shift_mm * shifts_[2].at(time_s) : 0;
}

}  // namespace handeye::simulator
