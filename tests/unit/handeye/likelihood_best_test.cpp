// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cctype>
#include <cstdint>
#include <map>
#include <string>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "daemon/handeye/selection.hpp"
#include "tests/unit/handeye/regimes.hpp"

/// maximum_likelihood against every other method there is, ours and OpenCV's, in every regime.
/// Built twice: as a test with few seeds, and for ./run bench regimes with two hundred and all of
/// OpenCV.
#ifndef HANDEYE_REGIME_SEEDS
#define HANDEYE_REGIME_SEEDS 40
#endif
#ifndef HANDEYE_REGIME_OPENCV_POSES
#define HANDEYE_REGIME_OPENCV_POSES 60
#endif

namespace handeye {
namespace {

using synthetic::Regime;
using synthetic::RegimeSample;
using synthetic::RmsError;

constexpr std::uint32_t kSeeds = HANDEYE_REGIME_SEEDS;
constexpr double kMostWorse = 1.03;
// OpenCV takes all pairs of poses: minutes where there are many.
constexpr std::size_t kMostForOpencv = HANDEYE_REGIME_OPENCV_POSES;
constexpr double kMmPerMetre = 1000;

constexpr std::array<std::pair<const char*, cv::HandEyeCalibrationMethod>, 5> kOpencv{
    {{"opencv TSAI", cv::CALIB_HAND_EYE_TSAI},
     {"opencv PARK", cv::CALIB_HAND_EYE_PARK},
     {"opencv HORAUD", cv::CALIB_HAND_EYE_HORAUD},
     {"opencv ANDREFF", cv::CALIB_HAND_EYE_ANDREFF},
     {"opencv DANIILIDIS", cv::CALIB_HAND_EYE_DANIILIDIS}}};

using Errors = std::map<std::string, RmsError>;

/// In metres, as its users have them: ANDREFF and DANIILIDIS depend on the unit.
Pose by_opencv(const std::vector<PosePair>& poses, cv::HandEyeCalibrationMethod method) {
  std::vector<cv::Mat> hand_rotations, hand_translations, eye_rotations, eye_translations;
  const auto append = [](const Pose& pose, std::vector<cv::Mat>& rotations,
                         std::vector<cv::Mat>& translations) {
    cv::eigen2cv(Eigen::Matrix3d(pose.linear()), rotations.emplace_back());
    cv::eigen2cv(Eigen::Vector3d(pose.translation() / kMmPerMetre), translations.emplace_back());
  };
  for (const PosePair& pair : poses) {
    append(pair.room_from_hand, hand_rotations, hand_translations);
    append(pair.eye_from_scene, eye_rotations, eye_translations);
  }
  cv::Mat rotation, translation;
  cv::calibrateHandEye(hand_rotations, hand_translations, eye_rotations, eye_translations, rotation,
                       translation, method);
  Eigen::Matrix3d matrix;
  Eigen::Vector3d metres;
  cv::cv2eigen(rotation, matrix);
  cv::cv2eigen(translation, metres);
  Pose hand_from_eye = Pose::Identity();
  hand_from_eye.linear() = nearest_rotation(matrix);
  hand_from_eye.translation() = kMmPerMetre * metres;
  return hand_from_eye;
}

void add_ours(const RegimeSample& sample, ScaleMode scale, Errors& errors) {
  const Selection selection = select_movements(sample.poses, {.scale = scale});
  for (const Method& method : methods(scale)) {
    const auto found = method.solve({.poses = sample.poses, .movements = selection.movements});
    // No answer is as wrong as none can be.
    const Pose answer = found ? found->hand_from_eye : Pose::Identity();
    errors[std::string(method.name)].add(
        synthetic::error_of(answer, sample.truth.solution.hand_from_eye));
  }
}

void add_opencv(const RegimeSample& sample, Errors& errors) {
  if (sample.poses.size() > kMostForOpencv) return;
  for (const auto& [name, method] : kOpencv) {
    errors[name].add(
        synthetic::error_of(by_opencv(sample.poses, method), sample.truth.solution.hand_from_eye));
  }
}

void expect_best(const Regime& regime, const char* scale, const Errors& errors) {
  const RmsError& ours = errors.at("maximum_likelihood");
  for (const auto& [name, error] : errors) {
    fmt::print("{:<20} {:<14} {:<28} {:8.4f} deg {:9.4f} mm\n", regime.name, scale, name,
               error.rotation_deg(), error.translation_mm());
    EXPECT_LE(ours.rotation_deg(), kMostWorse * error.rotation_deg()) << name;
    EXPECT_LE(ours.translation_mm(), kMostWorse * error.translation_mm()) << name;
  }
}

class LikelihoodAgainstAll : public testing::TestWithParam<std::size_t> {
 protected:
  const Regime& regime() const { return synthetic::regimes()[GetParam()]; }
};

TEST_P(LikelihoodAgainstAll, IsTheBestWithKnownScale) {
  Errors errors;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const RegimeSample sample = synthetic::sample(regime(), seed, 1.0);
    add_ours(sample, ScaleMode::kKnown, errors);
    add_opencv(sample, errors);
  }
  expect_best(regime(), "known scale", errors);
}

TEST_P(LikelihoodAgainstAll, IsTheBestWithUnknownScale) {
  Errors errors;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    add_ours(synthetic::sample(regime(), seed, 0.037), ScaleMode::kUnknown, errors);
  }
  expect_best(regime(), "unknown scale", errors);
}

std::string name_of(const testing::TestParamInfo<std::size_t>& info) {
  std::string name;
  for (const char c : synthetic::regimes()[info.param].name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Regimes, LikelihoodAgainstAll,
                         testing::Range<std::size_t>(0, synthetic::regimes().size()), name_of);

}  // namespace
}  // namespace handeye
