// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/perspective/chung_simulation.hpp"

#include "daemon/handeye/perspective/gibbs.hpp"

namespace handeye::test::chung {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

Pose turned(double angle_deg, const Vector3d& axis, const Vector3d& translation_mm) {
  return make_pose(Eigen::Quaterniond(AngleAxisd(rad_from_deg(angle_deg), axis.normalized())),
                   translation_mm);
}

Eigen::Matrix3d intrinsics_mm() {
  return Vector3d(kFocalLength_mm, kFocalLength_mm, 1.0).asDiagonal();
}

Pose eye_from_object(const Pose& hand1_from_hand) {
  return hand_from_eye().inverse() * hand1_from_hand.inverse() * hand_from_eye() *
         eye1_from_object();
}

}  // namespace

std::vector<Vector3d> CalibrationObject::points_mm() const {
  std::vector<Vector3d> points;
  for (int x = 0; x < count.x(); ++x) {
    for (int y = 0; y < count.y(); ++y) {
      for (int z = 0; z < count.z(); ++z) {
        const Vector3d fraction(x / (count.x() - 1.0), y / (count.y() - 1.0),
                                z / (count.z() - 1.0));
        points.emplace_back(from_mm + fraction.cwiseProduct(to_mm - from_mm));
      }
    }
  }
  return points;
}

Eigen::Vector2d pixel_mm() {
  return {0.0086 * 768.0 / 752.0 / 1.011, 0.0083};
}

SensorLens lens() {
  return {.pixel_mm = pixel_mm(), .centre_px = {256.0, 256.0}, .k1_per_mm2 = kK1_per_mm2};
}

Pose eye1_from_object() {
  Eigen::Matrix3d permutation;
  permutation << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  Pose pose = turned(2.0, Vector3d::UnitZ(), Vector3d(0, 100, 1500));
  pose.linear() = pose.linear() * AngleAxisd(rad_from_deg(-3.0), Vector3d::UnitX()) *
                  AngleAxisd(rad_from_deg(-5.0), Vector3d::UnitZ()) * permutation;
  return pose;
}

Pose hand_from_eye() {
  return turned(12.0, -Vector3d::UnitX(), {0, -100, 100});
}

std::vector<Pose> hand1_from_hands() {
  return {Pose::Identity(), turned(3.95, -Vector3d::UnitY(), {100, 0, 50}),
          turned(3.8, -Vector3d::UnitX(), {0, -100, 50})};
}

Pose object_from_hand() {
  return eye1_from_object().inverse() * hand_from_eye().inverse();
}

YVector y_vector(const Pose& object_from_hand) {
  YVector y;
  y << gibbs_from_rotation(Eigen::Quaterniond(object_from_hand.linear())),
      object_from_hand.translation();
  return y;
}

Pose pose_of(const YVector& y) {
  return make_pose(rotation_from_gibbs(y.head<3>()), y.tail<3>());
}

YVector printed_ideal() {
  return (YVector() << -7.5461, -7.1624, 0.93582, 100.776, -8.16494, 1573.89).finished();
}

YVector printed_distortion_ignored() {
  return (YVector() << -7.5032, -7.1235, 0.92420, 100.554, -10.6338, 1574.60).finished();
}

YVector printed_compensated() {
  return (YVector() << -7.5613, -7.1767, 0.93580, 99.8303, -8.01864, 1573.75).finished();
}

std::vector<PerspectiveMatrix> matrices() {
  std::vector<PerspectiveMatrix> all;
  for (const Pose& hand1_from_hand : hand1_from_hands()) {
    all.push_back(compose(intrinsics_mm(), eye_from_object(hand1_from_hand)));
  }
  return all;
}

Observations observe(const CalibrationObject& object, double k1_per_mm2) {
  SensorLens with = lens();
  with.k1_per_mm2 = k1_per_mm2;
  Observations observations{.width = kWidth, .height = kHeight, .pixel_mm = pixel_mm()};
  const auto exact = matrices();
  const auto hands = hand1_from_hands();
  for (std::size_t i = 0; i < hands.size(); ++i) {
    ObservedPosition position{.hand1_from_hand = hands[i]};
    for (const Vector3d& point : object.points_mm()) {
      const Eigen::Vector2d image = (exact[i] * point.homogeneous()).hnormalized();
      position.points.push_back({point, distorted_pixel(with, image)});
    }
    observations.positions.push_back(std::move(position));
  }
  return observations;
}

PerspectiveState truth() {
  return {.lens = lens(), .matrices = matrices(), .object_from_hand = object_from_hand()};
}

}  // namespace handeye::test::chung
