// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/bent_window.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/tracking/feature_tracker.hpp"
#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

using Eigen::Vector2d;

constexpr double kFocal_px = 520.0;
constexpr double kK1 = -0.3;
const Vector2d kCentre_px(319.5, 239.5);

CameraModel lens(double k1) {
  return {.width = 640,
          .height = 480,
          .fx = kFocal_px,
          .fy = kFocal_px,
          .cx = kCentre_px.x(),
          .cy = kCentre_px.y(),
          .distortion = {k1, 0, 0, 0, 0}};
}

AffineWarp warp(const Vector2d& middle_px, const Eigen::Matrix2d& linear) {
  return {middle_px.cast<float>(), linear.cast<float>()};
}

Eigen::Matrix2d turned(double deg) {
  return Eigen::Rotation2Dd(deg / 180.0 * std::numbers::pi).toRotationMatrix();
}

Vector2d bend_of(const CameraModel& camera, const Vector2d& taken_px, const AffineWarp& found) {
  const auto rays = window_rays(camera, taken_px);
  EXPECT_TRUE(rays.has_value());
  return rays ? bend_px(camera, *rays, found) : Vector2d::Zero();
}

TEST(BentWindow, IsStraightWithoutDistortion) {
  const AffineWarp found = warp({500.3, 99.1}, 1.3 * turned(25));
  EXPECT_LT(bend_of(lens(0), {200, 150}, found).norm(), 1e-9);
}

TEST(BentWindow, IsZeroWhereItWasTakenAndWhereTheLensBendsAlike) {
  const Vector2d arm(210, -60);
  EXPECT_LT(bend_of(lens(kK1), kCentre_px + arm, warp(kCentre_px + arm, turned(0))).norm(), 1e-6);
  // Turned about the centre, the lens is the same.
  const Vector2d there = kCentre_px + turned(70) * arm;
  EXPECT_LT(bend_of(lens(kK1), kCentre_px + arm, warp(there, turned(70))).norm(), 1e-4);
}

TEST(BentWindow, FollowsItsFirstOrder) {
  // Little distortion, for the first order to hold.
  constexpr double kLittle = -0.02;
  const Vector2d then(-90, 40);
  const Vector2d now(150, 80);
  const double grown = 1.2;
  const Eigen::Matrix2d linear = grown * turned(30);
  const Vector2d expected =
      4 * 22.0 * kLittle / (kFocal_px * kFocal_px) * (grown * grown * now - linear * then);
  const Vector2d bend = bend_of(lens(kLittle), kCentre_px + then, warp(kCentre_px + now, linear));
  EXPECT_LT((bend - expected).norm(), 0.05 * expected.norm());
}

TEST(BentWindow, KnowsTheLensOfHalvedImages) {
  // A pixel of the smaller image is the middle of four.
  const CameraModel small = halved(lens(kK1), 1);
  const Vector2d ray(0.3, -0.2);
  const Vector2d pixel = project<double>(lens(kK1), ray.homogeneous());
  const Vector2d in_small = project<double>(small, ray.homogeneous());
  EXPECT_LT((2 * in_small + Vector2d(0.5, 0.5) - pixel).norm(), 1e-9);
  EXPECT_EQ(small.width, 320);
}

TEST(BentWindow, IsNothingBeyondTheLensNorWhereItFolds) {
  // x (1 - r^2) turns back at r = 0.577, where it is 0.385.
  EXPECT_FALSE(window_rays(lens(-1), kCentre_px + Vector2d(0.384 * kFocal_px, 0)).has_value());
  EXPECT_TRUE(window_rays(lens(-1), kCentre_px + Vector2d(0.3 * kFocal_px, 0)).has_value());
  EXPECT_FALSE(window_rays(lens(-1), kCentre_px + Vector2d(300, 0)).has_value());
}

/// A flat picture under a camera with distortion that looks straight at it: between two images all
/// windows change affinely but for what the lens does.
class LensedTexture {
 public:
  explicit LensedTexture(const CameraModel& camera) : camera_(camera), map_(kSize) {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const Vector2d ideal = ideal_of(Vector2d(x, y));
        map_(y, x) = cv::Vec2f(static_cast<float>(ideal.x()), static_cast<float>(ideal.y()));
      }
    }
  }

  cv::Mat image(int frame) const {
    cv::Mat seen;
    cv::remap(texture_.image(frame), seen, map_, cv::noArray(), cv::INTER_CUBIC);
    return seen;
  }

  /// Where a point that was seen at `pixel` in frame `from` is in frame `to`.
  Vector2d moved(const Vector2d& pixel, int from, int to) const {
    const Vector2d ideal = texture_.moved(ideal_of(pixel), from, to);
    return project<double>(camera_, ((ideal - kIdealCentre_px) / kFocal_px).homogeneous());
  }

 private:
  inline static const cv::Size kSize{640, 480};
  inline static const cv::Size kIdealSize{1000, 800};
  inline static const Vector2d kIdealCentre_px{500, 400};

  /// As a camera without distortion sees it.
  Vector2d ideal_of(const Vector2d& pixel) const {
    return kFocal_px * *unproject(camera_, pixel) + kIdealCentre_px;
  }

  CameraModel camera_;
  test::MovingTexture texture_{kIdealSize};
  cv::Mat2f map_;
};

/// By what tracks are farther from the middle of the image than they truly are, in parts of how
/// much farther they have come: the regression of their errors upon it.
double stretch_of_tracks(const LensedTexture& scene, const std::optional<CameraModel>& known) {
  const auto tracker = make_feature_tracker({.lens = known});
  TrackedFrame tracked;
  std::map<std::int64_t, std::pair<Vector2d, int>> born;  // where, and in which frame
  double along = 0;
  double way = 0;
  for (int frame = 0; frame < 40; ++frame) {
    tracker->track(scene.image(frame), {}, 40'000'000L * frame, tracked);
    for (const Observation& seen : tracked.observations) {
      const auto [of, is_new] = born.try_emplace(seen.feature_id, seen.pixel, frame);
      if (is_new) continue;
      const auto& [from_px, then] = of->second;
      const Vector2d truth_px = scene.moved(from_px, then, frame);
      const Vector2d went_px = truth_px - from_px;
      if ((seen.pixel - truth_px).norm() > 0.5) continue;  // sits on something else
      along += (seen.pixel - truth_px).dot(went_px);
      way += went_px.squaredNorm();
    }
  }
  return along / way;
}

// A lens that is not counted looks like another focal length; an adjustment that is given the true
// one then puts the scene at a wrong depth.
TEST(BentWindow, DoesNotStretchTheTracksOfAKnownLens) {
  const LensedTexture scene(lens(kK1));
  const double unknown = stretch_of_tracks(scene, std::nullopt);
  const double known = stretch_of_tracks(scene, lens(kK1));
  std::printf("stretch of tracks: %.1e without the lens, %.1e with it\n", unknown, known);
  EXPECT_LT(unknown, -1e-4);
  EXPECT_LT(std::abs(known), 0.5 * std::abs(unknown));
}

}  // namespace
}  // namespace handeye
