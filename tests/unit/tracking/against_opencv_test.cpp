// SPDX-License-Identifier: BSD-3-Clause
// Beside OpenCV's Lucas-Kanade on the same frames, from the same corners, with known truth.
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "daemon/geometry/camera_model.hpp"
#include "tests/sequences/sequence.hpp"
#include "tests/unit/tracking/moving_texture.hpp"
#include "tests/unit/tracking/track_record.hpp"

namespace handeye {
namespace {

using test::Comparison;
using test::KnownMotion;

constexpr double kFramesPerSecond = 25.0;

std::string words(const Comparison& both) {
  const auto one = [](const test::TrackRecord& record) {
    return fmt::format("kept {} of {}, median {:.4f} px, rms {:.4f} px", record.kept,
                       record.corners, record.median_px, record.rms_px);
  };
  return fmt::format("ours: {}; OpenCV: {}", one(both.ours), one(both.opencv));
}

/// Gain of the light at a frame.
using Light = double (*)(int frame);

double even(int) {
  return 1.0;
}

/// +-35 %, once a second.
double flicker(int frame) {
  return 1.0 + 0.35 * std::sin(2 * kPi * frame / kFramesPerSecond);
}

/// From 135 % to 65 % and back, each within half a second, in five steps.
double stairs(int frame) {
  const double phase = std::fmod(frame / kFramesPerSecond, 1.0);
  const double down = phase < 0.5 ? 2.0 * phase : 2.0 - 2.0 * phase;
  return 1.35 - 0.7 * std::round(5.0 * down) / 5.0;
}

/// Of the picture's greys: tissue varies by some tens of grey levels about a hundred or so.
constexpr double kContrast = 0.3;
constexpr double kGround = 80.0;

/// The picture in a light, through a sensor.
cv::Mat lit(const cv::Mat& image, double gain, std::uint64_t noise_seed) {
  cv::Mat noise(image.size(), CV_32F);
  cv::RNG random(noise_seed + 1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 1.5);
  cv::Mat real;
  image.convertTo(real, CV_32F, gain * kContrast, gain * kGround);
  real += noise;
  real.convertTo(real, CV_8UC1);
  return real;
}

KnownMotion picture(Light light, int frames) {
  const cv::Size size(640, 480);
  const auto texture = std::make_shared<test::MovingTexture>(size);
  return {frames, size,
          [=](int frame) {
            const auto seed = static_cast<std::uint64_t>(frame);
            return lit(texture->image(frame), light(frame), seed);
          },
          [=](const Eigen::Vector2d& pixel, int frame) {
            return std::optional(texture->moved(pixel, 0, frame));
          }};
}

/// A rendered endoscopy: relief, perspective, a light that moves along.
KnownMotion endoscopy(const char* name, int frames) {
  struct Rendered {
    Rendered(const char* which, const sequences::SequenceOptions& options)
        : sequence(which, options) {}
    sequences::Sequence sequence;
    std::vector<sequences::SequenceFrame> frames;
    cv::Mat1f first_depth_mm;
  };
  const auto rendered = std::make_shared<Rendered>(
      name, sequences::SequenceOptions{.duration_s = frames / kFramesPerSecond});
  sequences::SequenceFrame frame;
  while (rendered->sequence.next(frame)) {
    if (rendered->first_depth_mm.empty()) rendered->first_depth_mm = frame.depth_mm.clone();
    rendered->frames.push_back(frame);
    rendered->frames.back().grey = frame.grey.clone();
  }
  const auto at = [rendered](int index) -> const sequences::SequenceFrame& {
    return rendered->frames[static_cast<std::size_t>(index)];
  };
  return {static_cast<int>(rendered->frames.size()), rendered->first_depth_mm.size(),
          [=](int index) { return at(index).grey; },
          [=](const Eigen::Vector2d& pixel, int index) -> std::optional<Eigen::Vector2d> {
            const CameraModel& camera = rendered->sequence.camera();
            const auto ray = unproject(camera, pixel);
            if (!ray) return std::nullopt;
            // Features begin at whole pixels.
            const double depth_mm =
                rendered->first_depth_mm(cv::Point(static_cast<int>(std::lround(pixel.x())),
                                                   static_cast<int>(std::lround(pixel.y()))));
            const Eigen::Vector3d in_eye =
                at(index).scene_from_eye.inverse() *
                (at(0).scene_from_eye * (depth_mm * ray->homogeneous().eval()));
            return project<double>(camera, in_eye);
          }};
}

void expect_no_worse(const Comparison& both) {
  EXPECT_LE(both.ours.median_px, both.opencv.median_px);
  EXPECT_LE(both.ours.rms_px, both.opencv.rms_px);
}

TEST(AgainstOpenCv, KeepsHalfAsManyMoreUnderFlicker) {
  const Comparison both = compare_with_opencv(picture(flicker, 40));
  SCOPED_TRACE(words(both));
  testing::Test::RecordProperty("figures", words(both));
  ASSERT_GT(both.ours.corners, 100);
  EXPECT_GE(both.ours.kept, 1.5 * both.opencv.kept);
  EXPECT_GT(both.ours.kept, 0.9 * both.ours.corners);
  expect_no_worse(both);
}

TEST(AgainstOpenCv, KeepsHalfAsManyMoreWhenTheLightGoesInSteps) {
  const Comparison both = compare_with_opencv(picture(stairs, 40));
  SCOPED_TRACE(words(both));
  testing::Test::RecordProperty("figures", words(both));
  ASSERT_GT(both.ours.corners, 100);
  EXPECT_GE(both.ours.kept, 1.5 * both.opencv.kept);
  EXPECT_GT(both.ours.kept, 0.9 * both.ours.corners);
  expect_no_worse(both);
}

TEST(AgainstOpenCv, IsNoWorseInEvenLight) {
  const Comparison both = compare_with_opencv(picture(even, 40));
  SCOPED_TRACE(words(both));
  testing::Test::RecordProperty("figures", words(both));
  ASSERT_GT(both.ours.corners, 100);
  EXPECT_GE(both.ours.kept, both.opencv.kept);
  expect_no_worse(both);
}

TEST(AgainstOpenCv, IsNoWorseInARenderedEndoscopy) {
  const Comparison both = compare_with_opencv(endoscopy("plain", 50));
  SCOPED_TRACE(words(both));
  testing::Test::RecordProperty("figures", words(both));
  ASSERT_GT(both.ours.corners, 60);
  EXPECT_GE(both.ours.kept, both.opencv.kept);
  expect_no_worse(both);
}

TEST(AgainstOpenCv, KeepsHalfAsManyMoreInARenderedEndoscopyThatFlickers) {
  const Comparison both = compare_with_opencv(endoscopy("flicker", 50));
  SCOPED_TRACE(words(both));
  testing::Test::RecordProperty("figures", words(both));
  ASSERT_GT(both.ours.corners, 60);
  EXPECT_GE(both.ours.kept, 1.5 * both.opencv.kept);
  expect_no_worse(both);
}

}  // namespace
}  // namespace handeye
