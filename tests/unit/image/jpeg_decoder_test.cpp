// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/image/jpeg_decoder.hpp"

#include <gtest/gtest.h>

#include "tests/unit/image/jpeg_images.hpp"

namespace handeye {
namespace {

const cv::Size kSize(320, 240);

class JpegDecoderTest : public testing::Test {
 protected:
  const cv::Mat image_ = smooth_texture(kSize.width, kSize.height, 1);
  const std::vector<std::uint8_t> jpeg_ = as_jpeg(image_);
  JpegDecoder decoder_;
  cv::Mat grey_;
};

TEST_F(JpegDecoderTest, DecodesGreyAsOpenCvDoes) {
  ASSERT_TRUE(decoder_.decode(jpeg_, kSize, grey_));
  EXPECT_EQ(cv::norm(grey_, cv::imdecode(jpeg_, cv::IMREAD_GRAYSCALE), cv::NORM_INF), 0);
  EXPECT_LT(cv::norm(grey_, image_, cv::NORM_INF), 16);
}

TEST_F(JpegDecoderTest, TakesTheLuminanceOfColourImages) {
  const std::vector<std::uint8_t> jpeg =
      as_jpeg(smooth_texture(kSize.width, kSize.height, 2, CV_8UC3));
  ASSERT_TRUE(decoder_.decode(jpeg, std::nullopt, grey_));
  EXPECT_EQ(cv::norm(grey_, cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE), cv::NORM_INF), 0);
}

TEST_F(JpegDecoderTest, DecodesProgressiveImages) {
  ASSERT_TRUE(decoder_.decode(as_jpeg(image_, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}), kSize, grey_));
  EXPECT_LT(cv::norm(grey_, image_, cv::NORM_INF), 16);
}

TEST_F(JpegDecoderTest, AcceptsPaddingAfterTheImage) {
  std::vector<std::uint8_t> padded = jpeg_;
  padded.resize(padded.size() + 4096, 0);
  EXPECT_TRUE(decoder_.decode(padded, kSize, grey_));
}

TEST_F(JpegDecoderTest, RefusesEveryImageCutShort) {
  for (const int percent : {0, 1, 5, 20, 50, 80, 95, 99}) {
    const auto cut = static_cast<std::ptrdiff_t>(jpeg_.size()) * percent / 100;
    const std::vector<std::uint8_t> part(jpeg_.begin(), jpeg_.begin() + cut);
    EXPECT_FALSE(decoder_.decode(part, kSize, grey_)) << percent << " %";
  }
}

TEST_F(JpegDecoderTest, RefusesDamagedImages) {
  std::vector<std::uint8_t> damaged = jpeg_;
  for (std::size_t i = 0; i < 200; ++i) damaged[damaged.size() / 2 + i] = 0xFF;
  EXPECT_FALSE(decoder_.decode(damaged, kSize, grey_));
}

TEST_F(JpegDecoderTest, RefusesWhatIsNoJpeg) {
  EXPECT_FALSE(decoder_.decode(std::vector<std::uint8_t>(1000, 7), std::nullopt, grey_));
  EXPECT_FALSE(decoder_.decode({}, std::nullopt, grey_));
}

TEST_F(JpegDecoderTest, RefusesAnotherSizeThanExpected) {
  EXPECT_FALSE(decoder_.decode(jpeg_, cv::Size(kSize.height, kSize.width), grey_));
}

TEST_F(JpegDecoderTest, WorksOnAfterADamagedImage) {
  const std::vector<std::uint8_t> part(jpeg_.begin(), jpeg_.begin() + 2000);
  ASSERT_FALSE(decoder_.decode(part, kSize, grey_));
  ASSERT_TRUE(decoder_.decode(jpeg_, kSize, grey_));
  EXPECT_LT(cv::norm(grey_, image_, cv::NORM_INF), 16);
}

TEST_F(JpegDecoderTest, KeepsTheImagesMemory) {
  ASSERT_TRUE(decoder_.decode(jpeg_, kSize, grey_));
  const std::uint8_t* const memory = grey_.data;
  ASSERT_TRUE(decoder_.decode(jpeg_, kSize, grey_));
  EXPECT_EQ(grey_.data, memory);
}

TEST(LooksLikeJpeg, KnowsTheFirstBytes) {
  EXPECT_TRUE(looks_like_jpeg(as_jpeg(smooth_texture(16, 16, 3))));
  EXPECT_FALSE(looks_like_jpeg(std::vector<std::uint8_t>{0x89, 'P', 'N', 'G'}));
  EXPECT_FALSE(looks_like_jpeg({}));
}

}  // namespace
}  // namespace handeye
