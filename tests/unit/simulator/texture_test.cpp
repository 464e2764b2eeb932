// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/texture.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "drivers/simulator/random_stream.hpp"

namespace handeye::simulator {
namespace {

constexpr TextureOptions kOptions;  // 4096 texels of 0.1 mm

TEST(Texture, SamplesItsTexelsBilinearlyAndPeriodically) {
  const Texture texture(4, kOptions);
  const cv::Mat1b image = texture.image();
  const auto at = [&](double column, double row) {
    return texture.sample(static_cast<float>(column * 0.1 - 204.8),
                          static_cast<float>(row * 0.1 - 204.8), 0.1F);
  };
  EXPECT_NEAR(at(17, 200), image(200, 17), 0.05);
  EXPECT_NEAR(at(17.5, 200), 0.5 * (image(200, 17) + image(200, 18)), 0.05);
  EXPECT_NEAR(at(17, 200.25), 0.75 * image(200, 17) + 0.25 * image(201, 17), 0.05);
  EXPECT_NEAR(at(17 + 4096, 200 - 4096), image(200, 17), 0.3);
  EXPECT_NEAR(at(4095.5, 30), 0.5 * (image(30, 4095) + image(30, 0)), 0.05);
}

TEST(Texture, CoarseLevelLiesWhereTheFineOneDoes) {
  const Texture texture(4, kOptions);
  // Mean difference between levels under shifts: smallest without one.
  const auto mismatch = [&](float shift_mm) {
    RandomStream random(1, Purpose::kTexture);
    double sum = 0;
    for (int i = 0; i < 50'000; ++i) {
      const auto x = static_cast<float>(random.uniform(-200, 200));
      const auto y = static_cast<float>(random.uniform(-200, 200));
      const float difference =
          texture.sample(x, y, 0.1F) - texture.sample(x + shift_mm, y + shift_mm, 1.0F);
      sum += difference * difference;
    }
    return sum;
  };
  const double left = mismatch(-0.02F);
  const double centre = mismatch(0.0F);
  const double right = mismatch(0.02F);
  // Vertex of the parabola through the three.
  const double vertex_mm = 0.02 * 0.5 * (left - right) / (left - 2 * centre + right);
  EXPECT_NEAR(vertex_mm, 0.0, 0.001);
}

TEST(Texture, UsesTheMiddleOfTheGreyScaleAndHasContrastEverywhere) {
  const Texture texture(9, kOptions);
  const cv::Mat1b image = texture.image();
  EXPECT_LT(cv::countNonZero(image == 0) + cv::countNonZero(image == 255),
            static_cast<int>(image.total() / 1000));
  // Every 3.2 mm patch (some 24 px) has enough structure to be tracked.
  for (int row = 0; row < kOptions.texels; row += 64) {
    for (int column = 0; column < kOptions.texels; column += 64) {
      cv::Scalar mean;
      cv::Scalar deviation;
      cv::meanStdDev(image(cv::Rect(column, row, 32, 32)), mean, deviation);
      EXPECT_GT(deviation[0], 5.0) << "patch at " << column << ", " << row;
    }
  }
}

}  // namespace
}  // namespace handeye::simulator
