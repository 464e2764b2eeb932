// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/image_inspector.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

using test::MovingTexture;

const cv::Size kSize(640, 480);

cv::Mat noisy(const cv::Mat& grey, double sigma, unsigned seed) {
  cv::Mat noise(grey.size(), CV_32FC1);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::Mat sum;
  cv::add(grey, noise, sum, cv::noArray(), CV_32F);
  sum.convertTo(sum, CV_8U);
  return sum;
}

cv::Mat coded(const cv::Mat& grey, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", grey, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

/// As through an endoscope: a disc on black.
cv::Mat in_disc(const cv::Mat& grey) {
  cv::Mat disc = cv::Mat::zeros(grey.size(), CV_8UC1);
  cv::circle(disc, {grey.cols / 2, grey.rows / 2}, 9 * grey.rows / 20, 255, cv::FILLED);
  cv::Mat image(grey.size(), CV_8UC1, cv::Scalar(3));
  grey.copyTo(image, disc);
  return image;
}

ImageCondition condition_of(const cv::Mat& image) {
  return ImageInspector().inspect(image);
}

TEST(ImageInspector, TellsTheDark) {
  EXPECT_EQ(condition_of(cv::Mat::zeros(kSize, CV_8UC1)), ImageCondition::kDark);
  // A lens cap at full gain, black at 16 as in video, a word on the screen.
  EXPECT_EQ(condition_of(noisy(cv::Mat(kSize, CV_8UC1, cv::Scalar(30)), 8, 1)),
            ImageCondition::kDark);
  cv::Mat written(kSize, CV_8UC1, cv::Scalar(16));
  cv::putText(written, "NO NAME 12:30", {20, 40}, cv::FONT_HERSHEY_SIMPLEX, 1, 235, 3);
  EXPECT_EQ(condition_of(noisy(written, 2, 2)), ImageCondition::kDark);
}

TEST(ImageInspector, LetsDimPicturesPass) {
  const MovingTexture texture(kSize);
  for (const double gain : {1.0, 0.5, 0.2}) {
    EXPECT_EQ(condition_of(noisy(texture.image(3) * gain, 1.5, 4)), ImageCondition::kGood) << gain;
    EXPECT_EQ(condition_of(noisy(in_disc(texture.image(3) * gain), 1.5, 4)), ImageCondition::kGood)
        << gain;
  }
}

TEST(ImageInspector, TellsABurntOutPicture) {
  const MovingTexture texture(kSize);
  EXPECT_EQ(condition_of(texture.image(0) * 10), ImageCondition::kBright);
  EXPECT_EQ(condition_of(in_disc(cv::Mat(kSize, CV_8UC1, cv::Scalar(255)))),
            ImageCondition::kBright);
  cv::Mat near_the_light = texture.image(0);
  cv::circle(near_the_light, {200, 200}, 150, 255, cv::FILLED);
  EXPECT_EQ(condition_of(near_the_light), ImageCondition::kGood);
}

TEST(ImageInspector, TellsAFrozenPictureFromALiveOneThatStandsStill) {
  const MovingTexture texture(kSize);
  const cv::Mat still = texture.image(0);
  for (const double sigma : {0.6, 1.0, 1.5, 4.0}) {
    for (const int quality : {0, 95, 90, 75, 50}) {
      const auto shot = [&](unsigned seed) {
        const cv::Mat image = noisy(still, sigma, seed);
        return quality > 0 ? coded(image, quality) : image;
      };
      ImageInspector inspector;
      EXPECT_EQ(inspector.inspect(shot(1)), ImageCondition::kGood);
      for (unsigned seed = 2; seed < 6; ++seed) {
        EXPECT_EQ(inspector.inspect(shot(seed)), ImageCondition::kGood) << sigma << " " << quality;
        EXPECT_EQ(inspector.inspect(shot(seed)), ImageCondition::kFrozen)
            << sigma << " " << quality;
      }
    }
  }
}

TEST(ImageInspector, SeesThroughWhatARepeatedPictureMayDifferBy) {
  const MovingTexture texture(kSize);
  for (const int quality : {95, 90, 75, 50}) {
    ImageInspector inspector;
    const cv::Mat last = coded(noisy(in_disc(texture.image(0)), 1.5, 1), quality);
    EXPECT_EQ(inspector.inspect(last), ImageCondition::kGood);
    EXPECT_EQ(inspector.inspect(coded(last, quality)), ImageCondition::kFrozen) << quality;
    EXPECT_EQ(inspector.inspect(noisy(last, 0.5, 2)), ImageCondition::kFrozen) << quality;
    cv::Mat clock = last.clone();
    cv::putText(clock, "12:30:01", {10, 30}, cv::FONT_HERSHEY_SIMPLEX, 0.6, 235, 2);
    EXPECT_EQ(inspector.inspect(clock), ImageCondition::kFrozen) << quality;
    EXPECT_EQ(inspector.inspect(noisy(in_disc(texture.image(1)), 1.5, 3)), ImageCondition::kGood);
  }
}

TEST(ImageInspector, LetsASlowMovementPassSooner) {
  // Without noise, a hundredth of a pixel a frame: each image is like the last, but not like the
  // last one used.
  const MovingTexture texture(kSize);
  const cv::Mat picture = texture.image(0);
  ImageInspector inspector;
  int used = 0;
  for (int frame = 0; frame < 50; ++frame) {
    const cv::Matx23d shift(1, 0, 0.02 * frame, 0, 1, 0);
    cv::Mat image;
    cv::warpAffine(picture, image, shift, kSize, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    used += inspector.inspect(image) == ImageCondition::kGood;
  }
  EXPECT_GE(used, 5);
  EXPECT_LE(used, 50);
}

class Blur : public testing::TestWithParam<bool> {
 protected:
  cv::Mat shot(int frame) const {
    const cv::Mat image = texture_.image(frame);
    return noisy(GetParam() ? in_disc(image) : image, 1.5, static_cast<unsigned>(frame) + 1);
  }
  cv::Mat blurred_shot(int frame, cv::Size blur) const {
    cv::Mat image = texture_.image(frame);
    cv::blur(image, image, blur);
    return noisy(GetParam() ? in_disc(image) : image, 1.5, static_cast<unsigned>(frame) + 1);
  }
  MovingTexture texture_{kSize};
};

TEST_P(Blur, IsToldInWhateverDirection) {
  ImageInspector inspector;
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_EQ(inspector.inspect(shot(frame)), ImageCondition::kGood) << frame;
  }
  for (const cv::Size blur : {cv::Size(25, 1), cv::Size(1, 25), cv::Size(17, 17)}) {
    EXPECT_EQ(inspector.inspect(blurred_shot(20, blur)), ImageCondition::kBlurred) << blur;
    EXPECT_EQ(inspector.inspect(shot(21)), ImageCondition::kGood) << blur;
  }
  EXPECT_EQ(inspector.inspect(blurred_shot(22, {3, 3})), ImageCondition::kGood);
}

TEST_P(Blur, ThatLastsForASecondIsToldAllThatTime) {
  ImageInspector inspector;
  for (int frame = 0; frame < 20; ++frame) inspector.inspect(shot(frame));
  for (int frame = 20; frame < 45; ++frame) {
    EXPECT_EQ(inspector.inspect(blurred_shot(frame, {25, 25})), ImageCondition::kBlurred) << frame;
  }
}

INSTANTIATE_TEST_SUITE_P(Fields, Blur, testing::Bool());

TEST(ImageInspector, IsNotFooledByLightThatChanges) {
  const MovingTexture texture(kSize);
  ImageInspector inspector;
  for (int frame = 0; frame < 50; ++frame) {
    const cv::Mat image = texture.image(frame) * (1.0 + 0.35 * std::sin(0.6 * frame));
    EXPECT_EQ(inspector.inspect(noisy(image, 1.5, static_cast<unsigned>(frame))),
              ImageCondition::kGood)
        << frame;
  }
}

TEST(ImageInspector, TakesImagesOfAnySize) {
  for (const cv::Size size : {cv::Size(3, 500), cv::Size(161, 7), cv::Size(1921, 1083)}) {
    ImageInspector inspector;
    EXPECT_EQ(inspector.inspect(cv::Mat::zeros(size, CV_8UC1)), ImageCondition::kDark) << size;
    inspector.inspect(cv::Mat(size, CV_8UC1, cv::Scalar(128)));
  }
}

TEST(ImageInspector, HasNoUseForWhatIsNotGrey) {
  ImageInspector inspector;
  EXPECT_EQ(inspector.inspect({}), ImageCondition::kUnusable);
  for (const int type : {CV_8UC3, CV_16UC1, CV_32FC1}) {
    EXPECT_EQ(inspector.inspect(cv::Mat::ones(480, 640, type)), ImageCondition::kUnusable);
  }
}

TEST(ImageCondition, TellsWhatShowsNothing) {
  EXPECT_TRUE(shows_nothing(ImageCondition::kDark));
  EXPECT_TRUE(shows_nothing(ImageCondition::kFrozen));
  EXPECT_TRUE(shows_nothing(ImageCondition::kUnusable));
  EXPECT_FALSE(shows_nothing(ImageCondition::kInterlaced));
}

}  // namespace
}  // namespace handeye
