// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <vector>

#include "daemon/handeye/perspective/lens.hpp"
#include "daemon/handeye/perspective/observations.hpp"

namespace handeye::test {

/// An endoscope-like scene: 8 positions, +-20 deg, object of about 60 mm, 120 mm away; Y is a
/// rotation by `y_angle_deg`.
struct Scene {
  Pose hand_from_eye{make_pose({0.8, 0.3, -0.2, 0.5}, {-30, 5, -280})};
  Pose object_from_hand;
  SensorLens lens{.pixel_mm = {0.003, 0.003}, .centre_px = {330, 250}, .k1_per_mm2 = 0.02};
  double focal_mm{2.1};
  double anamorphic{1.0};  ///< focal length in x over that in y
  std::vector<Pose> hand1_from_hands;
  Observations observations{.width = 640, .height = 480, .pixel_mm = {0.003, 0.003}};

  explicit Scene(bool planar, double y_angle_deg = 140.0, int positions = 8, unsigned seed = 3) {
    const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.8, 0.5).normalized();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(rad_from_deg(y_angle_deg), axis));
    // The camera looks at the middle of the object, 120 mm away.
    object_from_hand = make_pose(turn, {0, 0, 0});
    const Eigen::Vector3d middle(25, 25, planar ? 0 : 12);
    const Eigen::Vector3d seen = object_from_hand * (hand_from_eye * Eigen::Vector3d(0, 0, 120));
    object_from_hand.translation() = middle - seen;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < positions; ++i) {
      Pose eye1_from_eye = Pose::Identity();
      if (i > 0) {
        // Turns about the middle of what it looks at, and shifts.
        const Eigen::Vector3d target(0, 0, 120);
        eye1_from_eye.linear() = exp_so3(rad_from_deg(20.0) * vector());
        eye1_from_eye.translation() = target - eye1_from_eye.linear() * target + 15.0 * vector();
      }
      const Pose hand1_from_hand = hand_from_eye * eye1_from_eye * hand_from_eye.inverse();
      hand1_from_hands.push_back(hand1_from_hand);
      add_position(hand1_from_hand, planar);
    }
  }

  void add_position(const Pose& hand1_from_hand, bool planar) {
    ObservedPosition position{.hand1_from_hand = hand1_from_hand};
    const Pose eye_from_object = (object_from_hand * hand1_from_hand * hand_from_eye).inverse();
    for (int x = 0; x < 6; ++x) {
      for (int y = 0; y < 6; ++y) {
        const Eigen::Vector3d point(10.0 * x, 10.0 * y, planar ? 0.0 : 12.0 * ((x + 2 * y) % 3));
        Eigen::Vector2d image = focal_mm * (eye_from_object * point).hnormalized();
        image.x() *= anamorphic;
        position.points.push_back({point, distorted_pixel(lens, image)});
      }
    }
    observations.positions.push_back(std::move(position));
  }

  Scene& with_image_noise(double sigma_px, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, sigma_px);
    for (ObservedPosition& position : observations.positions) {
      for (ObjectPoint& point : position.points) {
        point.pixel += Eigen::Vector2d(noise(random), noise(random));
      }
    }
    return *this;
  }

  Scene& with_hand_noise(double sigma_deg, double sigma_mm, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    const auto vector = [&] {
      return Eigen::Vector3d(noise(random), noise(random), noise(random));
    };
    for (ObservedPosition& position : observations.positions) {
      Pose error = Pose::Identity();
      error.linear() = exp_so3(rad_from_deg(sigma_deg) * vector());
      error.translation() = sigma_mm * vector();
      position.hand1_from_hand = position.hand1_from_hand * error;
    }
    const Pose first = observations.positions.front().hand1_from_hand.inverse();
    for (ObservedPosition& position : observations.positions) {
      position.hand1_from_hand = first * position.hand1_from_hand;
    }
    return *this;
  }
};

}  // namespace handeye::test
