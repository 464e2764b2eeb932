// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/motion.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/geometry/camera_model.hpp"

namespace handeye::simulator {
namespace {

constexpr double kDurationS = 20.0;
constexpr double kStepS = 0.02;
const Eigen::Vector3d kTarget(0, 0, 3.0);

Motion motion_of(MotionKind kind, std::uint64_t seed = 6) {
  MotionOptions options;
  options.kind = kind;
  return Motion(seed, kTarget, options);
}

/// Calls `check` with the eye's pose now and one step later, all along the motion.
template <typename Check>
void for_each_step(const Motion& motion, Check check) {
  for (double time_s = 0; time_s < kDurationS; time_s += kStepS) {
    check(motion.surface_from_eye(time_s), motion.surface_from_eye(time_s + kStepS));
  }
}

TEST(Motion, NamesAreReadBack) {
  for (const auto kind : {MotionKind::kFree, MotionKind::kTranslation, MotionKind::kRotation,
                          MotionKind::kSingleAxis, MotionKind::kPivot, MotionKind::kStatic,
                          MotionKind::kWobble, MotionKind::kPivotSlide, MotionKind::kRollOnly}) {
    EXPECT_EQ(motion_from_name(motion_name(kind)), kind);
  }
  EXPECT_FALSE(motion_from_name("waltz").has_value());
}

TEST(Motion, FreeReachesItsLimitsAtAHandsSpeed) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Motion motion = motion_of(MotionKind::kFree, seed);
    const Eigen::Matrix3d home = Eigen::Vector3d(1, -1, -1).asDiagonal();
    Eigen::Vector3d largest_turn = Eigen::Vector3d::Zero();
    Eigen::Vector3d largest_shift = Eigen::Vector3d::Zero();
    double fastest_deg_s = 0;
    double fastest_mm_s = 0;
    for_each_step(motion, [&](const Pose& now, const Pose& next) {
      const Eigen::Vector3d turn = log_so3(home.transpose() * now.linear());
      const Eigen::Vector3d shift = now.translation() + 80.0 * now.linear().col(2) - kTarget;
      largest_turn = largest_turn.cwiseMax(turn.cwiseAbs());
      largest_shift = largest_shift.cwiseMax(shift.cwiseAbs());
      fastest_deg_s = std::max(
          fastest_deg_s, deg_from_rad(rotation_angle_rad(now.linear(), next.linear())) / kStepS);
      fastest_mm_s =
          std::max(fastest_mm_s, (next.translation() - now.translation()).norm() / kStepS);
    });
    EXPECT_LE(largest_turn.maxCoeff(), rad_from_deg(20.0) + 1e-9);
    EXPECT_GE(largest_turn.minCoeff(), rad_from_deg(19.0));
    EXPECT_LE(largest_shift.maxCoeff(), 15.0 + 1e-9);
    EXPECT_GE(largest_shift.minCoeff(), 14.0);
    EXPECT_GE(fastest_deg_s, 20.0);
    EXPECT_LE(fastest_deg_s, 55.0);
    EXPECT_LE(fastest_mm_s, 90.0);
  }
}

TEST(Motion, ImagesMoveSlowlyEnoughToBeTracked) {
  const CameraModel camera{640, 480, 600, 600, 319.5, 239.5, {}};
  for (const auto kind : {MotionKind::kFree, MotionKind::kTranslation, MotionKind::kRotation,
                          MotionKind::kSingleAxis, MotionKind::kPivot, MotionKind::kPivotSlide}) {
    const Motion motion = motion_of(kind);
    double largest_px = 0;
    double sum_px = 0;
    int frames = 0;
    for (double time_s = 0; time_s < kDurationS; time_s += 0.04) {
      // What is now in the middle of the image, on the plane through the target.
      const Pose now = motion.surface_from_eye(time_s);
      const Eigen::Vector3d axis = now.linear().col(2);
      const Eigen::Vector3d seen =
          now.translation() + axis * ((kTarget.z() - now.translation().z()) / axis.z());
      const Eigen::Vector3d later = motion.surface_from_eye(time_s + 0.04).inverse() * seen;
      const double moved_px =
          (project<double>(camera, later) - Eigen::Vector2d(319.5, 239.5)).norm();
      largest_px = std::max(largest_px, moved_px);
      sum_px += moved_px;
      ++frames;
    }
    EXPECT_LT(largest_px, 25.0) << motion_name(kind);
    EXPECT_GT(sum_px / frames, 2.0) << motion_name(kind);
  }
}

TEST(Motion, IsSmooth) {
  const Motion motion = motion_of(MotionKind::kFree);
  for (double time_s = 0; time_s < 60.0; time_s += 0.37) {
    // Second differences shrink with the square of the step: no kink, no jump.
    const auto bend = [&](double step_s) {
      const Eigen::Vector3d before = motion.surface_from_eye(time_s - step_s).translation();
      const Eigen::Vector3d here = motion.surface_from_eye(time_s).translation();
      const Eigen::Vector3d after = motion.surface_from_eye(time_s + step_s).translation();
      return (before - 2.0 * here + after).norm() / (step_s * step_s);
    };
    EXPECT_NEAR(bend(1e-3), bend(2e-3), 0.02);
    EXPECT_LT(bend(1e-3), 500.0);
  }
}

TEST(Motion, DoesNotRepeat) {
  const Motion motion = motion_of(MotionKind::kFree);
  // However it is shifted, the motion does not fall on itself: rms distance over 20 s.
  for (double shift_s = 1.0; shift_s < 120.0; shift_s += 0.05) {
    double sum = 0;
    int samples = 0;
    for (double time_s = 0; time_s < kDurationS; time_s += 0.2) {
      sum += (motion.surface_from_eye(time_s).translation() -
              motion.surface_from_eye(time_s + shift_s).translation())
                 .squaredNorm();
      ++samples;
    }
    EXPECT_GT(std::sqrt(sum / samples), 8.0) << "shifted by " << shift_s << " s";
  }
}

TEST(Motion, TranslationDoesNotTurn) {
  double path_mm = 0;
  for_each_step(motion_of(MotionKind::kTranslation), [&](const Pose& now, const Pose& next) {
    EXPECT_EQ(now.linear(), next.linear());
    path_mm += (next.translation() - now.translation()).norm();
  });
  EXPECT_GT(path_mm, 200.0);
}

TEST(Motion, RotationKeepsTheEyesCentre) {
  double turned_deg = 0;
  for_each_step(motion_of(MotionKind::kRotation), [&](const Pose& now, const Pose& next) {
    EXPECT_EQ(now.translation(), next.translation());
    turned_deg += deg_from_rad(rotation_angle_rad(now.linear(), next.linear()));
  });
  EXPECT_GT(turned_deg, 200.0);
}

TEST(Motion, SingleAxisTurnsAboutParallelAxes) {
  const Motion motion = motion_of(MotionKind::kSingleAxis);
  const Pose first = motion.surface_from_eye(0);
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double path_mm = 0;
  for_each_step(motion, [&](const Pose& now, const Pose& next) {
    path_mm += (next.translation() - now.translation()).norm();
    const Eigen::Vector3d turn = log_so3(first.linear().transpose() * now.linear());
    if (turn.norm() < rad_from_deg(3.0)) return;
    if (axis.isZero()) axis = turn.normalized();
    EXPECT_NEAR(turn.normalized().cross(axis).norm(), 0.0, 1e-9);
  });
  EXPECT_FALSE(axis.isZero());
  EXPECT_GT(path_mm, 200.0);
}

TEST(Motion, PivotKeepsItsPoint) {
  const Motion motion = motion_of(MotionKind::kPivot);
  const Eigen::Vector3d pivot = motion.surface_from_eye(0) * motion.pivot_in_eye();
  double path_mm = 0;
  for_each_step(motion, [&](const Pose& now, const Pose& next) {
    EXPECT_NEAR((now * motion.pivot_in_eye() - pivot).norm(), 0.0, 1e-9);
    path_mm += (next.translation() - now.translation()).norm();
  });
  EXPECT_GT(path_mm, 200.0);
}

TEST(Motion, SlidingPivotSlidesThroughItsPoint) {
  const Motion motion = motion_of(MotionKind::kPivotSlide);
  const Motion pivoting = motion_of(MotionKind::kPivot);
  const Eigen::Vector3d pivot = pivoting.surface_from_eye(0) * pivoting.pivot_in_eye();
  double least_mm = 1e9;
  double most_mm = 0;
  for_each_step(motion, [&](const Pose& now, const Pose&) {
    const Eigen::Vector3d pivot_in_eye = now.inverse() * pivot;
    EXPECT_NEAR(pivot_in_eye.head<2>().norm(), 0.0, 1e-9) << "the scope leads through it";
    least_mm = std::min(least_mm, -pivot_in_eye.z());
    most_mm = std::max(most_mm, -pivot_in_eye.z());
  });
  EXPECT_NEAR(least_mm, 85.0, 1.0);
  EXPECT_NEAR(most_mm, 115.0, 1.0);
}

TEST(Motion, WobbleIsLessThanTheTrackersNoise) {
  const Motion motion = motion_of(MotionKind::kWobble);
  const Pose first = motion.surface_from_eye(0);
  double turned_deg = 0;
  double moved_mm = 0;
  for_each_step(motion, [&](const Pose& now, const Pose&) {
    turned_deg =
        std::max(turned_deg, deg_from_rad(rotation_angle_rad(now.linear(), first.linear())));
    moved_mm = std::max(moved_mm, (now.translation() - first.translation()).norm());
  });
  EXPECT_LT(turned_deg, 0.07);
  EXPECT_GT(turned_deg, 0.02);
  EXPECT_LT(moved_mm, 0.14);
  EXPECT_GT(moved_mm, 0.04);
}

TEST(Motion, RollKeepsTheOpticalAxis) {
  const Motion motion = motion_of(MotionKind::kRollOnly);
  const Pose first = motion.surface_from_eye(0);
  double turned_deg = 0;
  for_each_step(motion, [&](const Pose& now, const Pose& next) {
    EXPECT_EQ(now.translation(), first.translation());
    EXPECT_TRUE(now.linear().col(2).isApprox(first.linear().col(2), 1e-12));
    turned_deg += deg_from_rad(rotation_angle_rad(now.linear(), next.linear()));
  });
  EXPECT_GT(turned_deg, 100.0);
}

TEST(Motion, StaticStays) {
  for_each_step(motion_of(MotionKind::kStatic),
                [](const Pose& now, const Pose& next) { EXPECT_TRUE(now.isApprox(next, 0.0)); });
}

}  // namespace
}  // namespace handeye::simulator
