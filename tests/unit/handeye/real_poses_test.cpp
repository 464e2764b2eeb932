// SPDX-License-Identifier: BSD-3-Clause
// Poses that others measured, by every method, beside OpenCV's PARK. The measure is that of the
// data's own page, whose figures are reproduced first: PARK for the rotation, least squares of
// E X = X H over all pairs of poses i < j for the translation, rms over the same pairs.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/quaternion_objective.hpp"
#include "daemon/handeye/selection.hpp"
#include "daemon/handeye/types.hpp"
#include "drivers/recording/pose_file.hpp"

namespace handeye {
namespace {

std::filesystem::path pose_folder() {
  const char* configured = std::getenv("HANDEYE_DATA");
  const std::filesystem::path data = configured ? configured : HANDEYE_SOURCE_DIR "/../shared/data";
  return data / "poses";
}

std::vector<PosePair> read_poses(const std::string& name) {
  std::vector<PosePair> poses;
  for (const PoseRow& row : read_pose_file(pose_folder() / (name + ".csv"))) {
    poses.push_back({row.room_from_hand, row.eye_from_scene});
  }
  return poses;
}

std::vector<Movement> all_movements(const std::vector<PosePair>& poses) {
  std::vector<Movement> movements;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      movements.push_back(movement_between(poses[i], poses[j]));
    }
  }
  return movements;
}

struct Misfit {
  double rotation_deg{0};
  double translation_mm{0};      ///< of H X^-1 - X^-1 E, as the data's page gives it
  double eye_translation_mm{0};  ///< of E X - X H, which most methods solve
};

/// Rms over the movements; X = eye_from_hand.
Misfit misfit(const std::vector<Movement>& movements, const Pose& hand_from_eye) {
  const Pose eye_from_hand = hand_from_eye.inverse();
  Misfit square;
  for (const auto& [hand, eye] : movements) {
    const Pose left = eye * eye_from_hand;
    const Pose right = eye_from_hand * hand;
    const double angle = rotation_angle_rad(left.linear(), right.linear());
    square.rotation_deg += std::pow(deg_from_rad(angle), 2);
    square.eye_translation_mm += (left.translation() - right.translation()).squaredNorm();
    square.translation_mm +=
        ((hand * hand_from_eye).translation() - (hand_from_eye * eye).translation()).squaredNorm();
  }
  const auto n = static_cast<double>(movements.size());
  return {std::sqrt(square.rotation_deg / n), std::sqrt(square.translation_mm / n),
          std::sqrt(square.eye_translation_mm / n)};
}

/// For a given rotation, t_X of (I - R_E) t_X = t_E - R_X t_H by least squares.
Pose with_least_squares_translation(const std::vector<Movement>& movements,
                                    const Eigen::Matrix3d& hand_from_eye) {
  const Eigen::Matrix3d eye_from_hand = hand_from_eye.transpose();
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& [hand, eye] : movements) {
    const Eigen::Matrix3d rows = Eigen::Matrix3d::Identity() - eye.linear();
    normal += rows.transpose() * rows;
    right += rows.transpose() * (eye.translation() - eye_from_hand * hand.translation());
  }
  Pose pose = Pose::Identity();
  pose.linear() = hand_from_eye;
  pose.translation() = -hand_from_eye * normal.ldlt().solve(right);
  return pose;
}

cv::Mat to_opencv(const Eigen::MatrixXd& matrix) {
  cv::Mat result(static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()), CV_64F);
  for (int i = 0; i < result.rows; ++i) {
    for (int j = 0; j < result.cols; ++j) result.at<double>(i, j) = matrix(i, j);
  }
  return result;
}

/// OpenCV's own answer; its translation is the least-squares one for its rotation.
Pose opencv_park(const std::vector<PosePair>& poses) {
  std::vector<cv::Mat> hand_rotations, hand_translations, eye_rotations, eye_translations;
  for (const PosePair& pair : poses) {
    hand_rotations.push_back(to_opencv(pair.room_from_hand.linear()));
    hand_translations.push_back(to_opencv(pair.room_from_hand.translation()));
    eye_rotations.push_back(to_opencv(pair.eye_from_scene.linear()));
    eye_translations.push_back(to_opencv(pair.eye_from_scene.translation()));
  }
  cv::Matx33d rotation;
  cv::Vec3d translation;
  cv::calibrateHandEye(hand_rotations, hand_translations, eye_rotations, eye_translations, rotation,
                       translation, cv::CALIB_HAND_EYE_PARK);
  Pose hand_from_eye = Pose::Identity();
  for (int i = 0; i < 9; ++i) hand_from_eye.linear()(i / 3, i % 3) = rotation(i / 3, i % 3);
  hand_from_eye.translation() = Eigen::Vector3d(translation[0], translation[1], translation[2]);
  return hand_from_eye;
}

std::string table_row(std::string_view method, const Misfit& m, const Eigen::Vector3d& t_mm) {
  return fmt::format("  {:<28}{:>9.3f} deg{:>9.2f} mm{:>9.2f} mm   t {:>9.2f}{:>9.2f}{:>9.2f} mm\n",
                     method, m.rotation_deg, m.translation_mm, m.eye_translation_mm, t_mm.x(),
                     t_mm.y(), t_mm.z());
}

/// horaud_nonlinear with the quaternion's norm held at 1 exactly, not by the printed penalty.
std::optional<Pose> horaud_with_unit_norm(const std::vector<Movement>& movements,
                                          const Pose& start) {
  const Pose eye_from_hand = start.inverse();
  const Eigen::Quaterniond q(eye_from_hand.linear());
  const auto found =
      QuaternionObjective(movements, q)
          .minimise({q, eye_from_hand.translation(), 1.0},
                    {.free_scale = false, .unit_norm = QuaternionOptions::UnitNorm::kManifold});
  if (!found) return std::nullopt;
  return make_pose(found->q, found->t).inverse();
}

/// A set, and what the data's own page says of OpenCV's PARK on it.
struct RealSet {
  const char* name;
  std::size_t rows;
  double park_rotation_deg;
  double park_translation_mm;
  double rounding_deg;  ///< half of the last digit printed there
  double rounding_mm;
  double lowest_scale;  ///< units per mm that the freed scale must find; 0: no reference
  double highest_scale;
};

void PrintTo(const RealSet& set, std::ostream* stream) {
  *stream << set.name;
}

class RealPoses : public ::testing::TestWithParam<RealSet> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(pose_folder())) {
      GTEST_SKIP() << pose_folder() << " is not there: set HANDEYE_DATA";
    }
    poses_ = read_poses(GetParam().name);
    movements_ = all_movements(poses_);
    ASSERT_EQ(poses_.size(), GetParam().rows);
  }

  std::vector<PosePair> poses_;
  std::vector<Movement> movements_;
};

INSTANTIATE_TEST_SUITE_P(
    Sets, RealPoses,
    ::testing::Values(RealSet{"vicon_primesense", 128, 2.00, 31.8, 0.005, 0.05, 0.97, 1.01},
                      RealSet{"moveit", 50, 0.127, 6.59, 0.0005, 0.005, 0.9995, 1.0005},
                      RealSet{"visp_franka", 8, 0.69, 7.7, 0.005, 0.05, 1 / 1.155, 1 / 1.125},
                      RealSet{"laparoscope", 10, 0.55, 1.46, 0.005, 0.005, 0, 0},
                      RealSet{"loose_robot_cal_tools", 15, 1.73, 31.1, 0.006, 0.05, 0, 0},
                      // Its page gives no figures: the data hold gross errors.
                      RealSet{"outliers_camodocal", 42, 0, 0, 0, 0, 0, 0}),
    [](const auto& set) { return std::string(set.param.name); });

TEST_P(RealPoses, KnownScaleIsSolvedAsWellAsByOpenCv) {
  const Pose park = opencv_park(poses_);
  const Pose reference_pose = with_least_squares_translation(movements_, park.linear());
  const Misfit reference = misfit(movements_, reference_pose);
  std::string table = fmt::format("{}: {} poses, scale known\n", GetParam().name, poses_.size());
  table += table_row("PARK, least squares", reference, reference_pose.translation());
  table += table_row("OpenCV PARK", misfit(movements_, park), park.translation());
  if (GetParam().park_translation_mm > 0) {
    EXPECT_NEAR(reference.rotation_deg, GetParam().park_rotation_deg, GetParam().rounding_deg);
    EXPECT_NEAR(reference.translation_mm, GetParam().park_translation_mm, GetParam().rounding_mm);
  }

  const Selection selection = select_movements(poses_, {.scale = ScaleMode::kKnown});
  const HandEyeProblem problem{.poses = poses_, .movements = selection.movements};
  for (const Method& method : methods(ScaleMode::kKnown)) {
    SCOPED_TRACE(method.name);
    const auto solution = method.solve(problem);
    ASSERT_TRUE(solution);
    EXPECT_EQ(solution->scale_units_per_mm, 1.0);
    const Misfit ours = misfit(movements_, solution->hand_from_eye);
    table += table_row(method.name, ours, solution->hand_from_eye.translation());
    if (method.name == "horaud_nonlinear") continue;  // has a test of its own
    EXPECT_LT(ours.rotation_deg, 1.05 * reference.rotation_deg);
    // It solves E X = X H, and there it is within 5 %; X^-1 and 277 mm between hand and eye make
    // 7 % of that.
    const bool magnified =
        method.name == "daniilidis" && std::string_view(GetParam().name) == "laparoscope";
    if (magnified) {
      EXPECT_LT(ours.eye_translation_mm, 1.05 * reference.eye_translation_mm);
    }
    EXPECT_LT(ours.translation_mm, (magnified ? 1.10 : 1.05) * reference.translation_mm);
  }
  std::cout << table;
}

// As printed it adds squared quaternions, at most 4, to squared mm: the translation alone decides
// and the rotation gives way to it. And only a penalty holds the quaternion's norm at 1, which
// gives way where another scale would fit better. With the norm held it fits E X = X H as well as
// any.
TEST_P(RealPoses, HoraudsFunctionAsPrintedTradesRotationForTranslation) {
  const Pose reference_pose =
      with_least_squares_translation(movements_, opencv_park(poses_).linear());
  const Misfit reference = misfit(movements_, reference_pose);
  const Selection selection = select_movements(poses_, {.scale = ScaleMode::kKnown});
  const auto printed = horaud_nonlinear({.poses = poses_, .movements = selection.movements});
  const auto held = horaud_with_unit_norm(selection.movements, reference_pose);
  ASSERT_TRUE(printed && held);
  const Misfit ours = misfit(movements_, printed->hand_from_eye);
  const Misfit with_unit_norm = misfit(movements_, *held);
  EXPECT_LT(with_unit_norm.eye_translation_mm, 1.01 * reference.eye_translation_mm);
  EXPECT_LT(ours.rotation_deg, 2.2 * reference.rotation_deg);
  EXPECT_LT(ours.translation_mm, 1.2 * reference.translation_mm);
  std::cout << GetParam().name << '\n'
            << table_row("PARK, least squares", reference, reference_pose.translation())
            << table_row("horaud_nonlinear", ours, printed->hand_from_eye.translation())
            << table_row("  with unit norm", with_unit_norm, held->translation());
}

TEST_P(RealPoses, AFreedScaleIsTheSquaresOwn) {
  if (GetParam().lowest_scale == 0) GTEST_SKIP() << "no reference for its scale";
  const Selection selection = select_movements(poses_);
  const HandEyeProblem problem{.poses = poses_, .movements = selection.movements};
  std::string table = fmt::format("{}: scale freed\n", GetParam().name);
  for (const Method& method : methods(ScaleMode::kUnknown)) {
    const auto solution = method.solve(problem);
    ASSERT_TRUE(solution) << method.name;
    table +=
        fmt::format("  {:<28}{:>9.4f} units per mm\n", method.name, solution->scale_units_per_mm);
    EXPECT_GT(solution->scale_units_per_mm, GetParam().lowest_scale) << method.name;
    EXPECT_LT(solution->scale_units_per_mm, GetParam().highest_scale) << method.name;
  }
  std::cout << table;
}

}  // namespace
}  // namespace handeye
