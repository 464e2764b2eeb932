// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/patch_alignment.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

const cv::Size kSize(160, 120);
constexpr int kX = 80;
constexpr int kY = 60;

/// Smooth at the scale of a few pixels, exactly known everywhere.
double texture(double x, double y) {
  return 110 + 18 * std::sin(0.31 * x + 0.2 * y) + 15 * std::cos(0.27 * y - 0.12 * x) +
         12 * std::sin(0.05 * x * y / 20 + 0.4 * x);
}

struct Light {
  double gain{1}, offset{0}, ramp_x{0}, ramp_y{0};
};

/// What a camera sees when the texture's (kX, kY) has gone to `warp`.
cv::Mat image_of(const AffineWarp& warp, const Light& light = {}) {
  const Eigen::Matrix2d inverse = warp.linear.cast<double>().inverse();
  cv::Mat image(kSize, CV_8UC1);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const Eigen::Vector2d p = inverse * (Eigen::Vector2d(x, y) - warp.centre.cast<double>());
      const double value = light.gain * texture(kX + p.x(), kY + p.y()) + light.offset +
                           light.ramp_x * (x - kX) + light.ramp_y * (y - kY);
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(value);
    }
  }
  return image;
}

ImagePyramid pyramid_of(const cv::Mat& image, const cv::Mat& mask = {}) {
  ImagePyramid pyramid;
  pyramid.build(image, mask, 0, 3);
  return pyramid;
}

AffineWarp original() {
  return {{static_cast<float>(kX), static_cast<float>(kY)}, Eigen::Matrix2f::Identity()};
}

AffineWarp turned(double angle_rad, double growth, double dx, double dy) {
  AffineWarp warp = original();
  warp.centre += Eigen::Vector2d(dx, dy).cast<float>();
  warp.linear = (growth * Eigen::Rotation2Dd(angle_rad).toRotationMatrix()).cast<float>();
  return warp;
}

Appearance appearance() {
  Appearance first;
  EXPECT_TRUE(first.take(pyramid_of(image_of(original())), kX, kY));
  return first;
}

TEST(Appearance, IsFoundWhereItWentAndHowItTurned) {
  const AffineWarp truth = turned(0.12, 1.08, 1.3, -0.7);
  AffineWarp warp = original();
  const PatchFit fit = appearance().align(pyramid_of(image_of(truth)), warp);
  ASSERT_TRUE(fit.found);
  EXPECT_GT(fit.correlation, 0.999F);
  EXPECT_LT((warp.centre - truth.centre).norm(), 0.02F);
  EXPECT_LT((warp.linear - truth.linear).norm(), 0.01F);
}

TEST(Appearance, IsFoundInAnyLight) {
  const AffineWarp truth = turned(-0.05, 0.97, -0.8, 0.4);
  for (const Light& light : {Light{0.65, 0, 0, 0}, Light{1.35, 10, 0, 0}, Light{1, -30, 0, 0},
                             Light{0.8, 5, 0.6, -0.4}}) {
    AffineWarp warp = original();
    const PatchFit fit = appearance().align(pyramid_of(image_of(truth, light)), warp);
    ASSERT_TRUE(fit.found);
    EXPECT_LT((warp.centre - truth.centre).norm(), 0.03F) << light.gain << " " << light.ramp_x;
  }
}

TEST(Appearance, IsFoundThoughAThirdOfItIsMasked) {
  const AffineWarp truth = turned(0.03, 1.02, 0.6, 0.9);
  const cv::Mat clean = image_of(truth);
  cv::Mat spotted = clean.clone();
  spotted(cv::Rect(88, 45, 40, 40)) = 255;
  cv::Mat mask(kSize, CV_8UC1, cv::Scalar(255));
  mask(cv::Rect(86, 43, 44, 44)) = 0;  // as highlights are masked, with a margin
  AffineWarp warp = original();
  const PatchFit fit = appearance().align(pyramid_of(spotted, mask), warp);
  ASSERT_TRUE(fit.found);
  EXPECT_LT((warp.centre - truth.centre).norm(), 3 * fit.sigma_px);
  EXPECT_LT(fit.sigma_px, 0.03F);
  // What is under the mask has no say.
  AffineWarp without = original();
  ASSERT_TRUE(appearance().align(pyramid_of(clean, mask), without).found);
  EXPECT_EQ(warp.centre, without.centre);
}

/// A fit to what is only half the same picture, with the right third of it masked.
PatchFit fit_to_half_alike(const Appearance& first) {
  cv::Mat other = image_of(original());
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      auto& pixel = other.at<std::uint8_t>(y, x);
      pixel = cv::saturate_cast<std::uint8_t>(pixel + 45 * std::sin(0.9 * x) * std::cos(0.8 * y));
    }
  }
  cv::Mat mask(kSize, CV_8UC1, cv::Scalar(255));
  mask.colRange(kX + 4, kSize.width) = 0;
  AffineWarp warp = original();
  return first.align(pyramid_of(other, mask), warp);
}

TEST(Appearance, IsNoMoreAlikeForAStepUnderTheMask) {
  const PatchFit plain = fit_to_half_alike(appearance());
  ASSERT_TRUE(plain.found);
  EXPECT_LT(plain.correlation, 0.9F);
  cv::Mat stepped = image_of(original());
  stepped.colRange(kX + 7, kSize.width) = 0;
  Appearance with_step;
  ASSERT_TRUE(with_step.take(pyramid_of(stepped), kX, kY));
  const PatchFit fit = fit_to_half_alike(with_step);
  ASSERT_TRUE(fit.found);
  EXPECT_NEAR(fit.correlation, plain.correlation, 1e-4F);
}

TEST(Appearance, IsNotFoundInAnotherPictureOrInNone) {
  cv::Mat noise(kSize, CV_8UC1);
  cv::RNG random(4);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  AffineWarp warp = original();
  const PatchFit fit = appearance().align(pyramid_of(noise), warp);
  EXPECT_FALSE(fit.found && fit.correlation > 0.8F);
  warp = original();
  EXPECT_FALSE(appearance().align(pyramid_of(cv::Mat::zeros(kSize, CV_8UC1)), warp).found);
  warp = original();
  warp.centre = {-200, 50};
  EXPECT_FALSE(appearance().align(pyramid_of(image_of(original())), warp).found);
}

TEST(Appearance, NeedsTexture) {
  Appearance flat;
  EXPECT_FALSE(flat.take(pyramid_of(cv::Mat(kSize, CV_8UC1, cv::Scalar(90))), kX, kY));
  cv::Mat edge(kSize, CV_8UC1, cv::Scalar(90));
  edge(cv::Rect(kX, 0, kX, kSize.height)) = 160;  // slides along itself
  EXPECT_FALSE(flat.take(pyramid_of(edge), kX, kY));
}

TEST(AlignShift, FollowsALevelFromImageToImage) {
  const ImagePyramid before = pyramid_of(image_of(original()));
  const ImagePyramid now = pyramid_of(image_of(turned(0, 1, 3.4, -2.2), {1.3, -8, 0, 0}));
  for (const int level : {0, 1}) {
    const auto scale = static_cast<float>(1 << level);
    const Eigen::Vector2f from = Eigen::Vector2f(kX + 0.4F, kY - 0.3F) / scale;
    Eigen::Vector2f to = from;
    ASSERT_TRUE(align_shift(before, now, level, from, to).found);
    EXPECT_LT((scale * (to - from) - Eigen::Vector2f(3.4F, -2.2F)).norm(), 0.1F) << level;
  }
}

}  // namespace
}  // namespace handeye
