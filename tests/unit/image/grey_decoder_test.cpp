// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/image/grey_decoder.hpp"

#include <gtest/gtest.h>

#include "tests/unit/image/jpeg_images.hpp"

namespace handeye {
namespace {

constexpr int kWidth = 22;
constexpr int kHeight = 7;

std::uint8_t luminance_at(int x, int y) {
  return static_cast<std::uint8_t>(3 + 11 * x + 31 * y);
}

/// An image with luminance_at() everywhere, colour 200 and padding 77, as a camera would lay it
/// out.
std::vector<std::uint8_t> lay_out(PixelFormat format, int stride_bytes) {
  const bool packed = format == PixelFormat::kYuyv || format == PixelFormat::kUyvy;
  const int step = packed ? 2 : 1;
  const int first = format == PixelFormat::kUyvy ? 1 : 0;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(stride_bytes) * kHeight, 77);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto pixel = static_cast<std::size_t>(y * stride_bytes + x * step);
      if (packed) bytes[pixel + static_cast<std::size_t>(1 - first)] = 200;
      bytes[pixel + static_cast<std::size_t>(first)] = luminance_at(x, y);
    }
  }
  if (format == PixelFormat::kNv12) {
    bytes.resize(bytes.size() + static_cast<std::size_t>(stride_bytes) * (kHeight / 2), 200);
  }
  return bytes;
}

struct Layout {
  PixelFormat format;
  int row_bytes;
  int padding_bytes;
};

class RawFormats : public testing::TestWithParam<Layout> {
 protected:
  const int stride_bytes_ = GetParam().row_bytes + GetParam().padding_bytes;
  std::vector<std::uint8_t> bytes_ = lay_out(GetParam().format, stride_bytes_);
  EncodedImage image_{GetParam().format, kWidth, kHeight, stride_bytes_, bytes_};
  GreyDecoder decoder_;
  cv::Mat grey_;
};

TEST_P(RawFormats, GiveTheLuminanceOfEveryPixel) {
  ASSERT_TRUE(decoder_.decode(image_, grey_));
  ASSERT_EQ(grey_.size(), cv::Size(kWidth, kHeight));
  ASSERT_EQ(grey_.type(), CV_8UC1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_EQ(grey_.at<std::uint8_t>(y, x), luminance_at(x, y)) << x << "," << y;
    }
  }
}

TEST_P(RawFormats, KeepTheImagesMemory) {
  ASSERT_TRUE(decoder_.decode(image_, grey_));
  const std::uint8_t* const memory = grey_.data;
  ASSERT_TRUE(decoder_.decode(image_, grey_));
  EXPECT_EQ(grey_.data, memory);
  EXPECT_NE(grey_.data, bytes_.data()) << "the image must own its pixels";
}

TEST_P(RawFormats, RefuseTooFewBytes) {
  const auto needed =
      static_cast<std::size_t>(stride_bytes_ * (kHeight - 1) + GetParam().row_bytes);
  image_.bytes = std::span(bytes_).first(needed);
  EXPECT_TRUE(decoder_.decode(image_, grey_)) << "the last row needs no padding";
  image_.bytes = std::span(bytes_).first(needed - 1);
  EXPECT_FALSE(decoder_.decode(image_, grey_));
  image_.bytes = {};
  EXPECT_FALSE(decoder_.decode(image_, grey_));
}

TEST_P(RawFormats, RefuseRowsThatOverlap) {
  image_.stride_bytes = GetParam().row_bytes - 1;
  EXPECT_FALSE(decoder_.decode(image_, grey_));
  image_.stride_bytes = -stride_bytes_;
  EXPECT_FALSE(decoder_.decode(image_, grey_));
}

TEST_P(RawFormats, RefuseSizesOutOfRange) {
  for (const int width : {0, -1, kMaxImageSide + 1}) {
    image_.width = width;
    EXPECT_FALSE(decoder_.decode(image_, grey_)) << width;
  }
}

INSTANTIATE_TEST_SUITE_P(All, RawFormats,
                         testing::Values(Layout{PixelFormat::kGrey, kWidth, 0},
                                         Layout{PixelFormat::kGrey, kWidth, 10},
                                         Layout{PixelFormat::kYuyv, 2 * kWidth, 0},
                                         Layout{PixelFormat::kYuyv, 2 * kWidth, 20},
                                         Layout{PixelFormat::kUyvy, 2 * kWidth, 0},
                                         Layout{PixelFormat::kUyvy, 2 * kWidth, 20},
                                         Layout{PixelFormat::kNv12, kWidth, 0},
                                         Layout{PixelFormat::kNv12, kWidth, 42}),
                         [](const auto& test) {
                           return std::string(name_of(test.param.format)) + "Padding" +
                                  std::to_string(test.param.padding_bytes);
                         });

TEST(GreyDecoder, TakesAStrideOfZeroAsNoPadding) {
  const std::vector<std::uint8_t> bytes = lay_out(PixelFormat::kYuyv, 2 * kWidth);
  cv::Mat grey;
  ASSERT_TRUE(GreyDecoder().decode({PixelFormat::kYuyv, kWidth, kHeight, 0, bytes}, grey));
  EXPECT_EQ(grey.at<std::uint8_t>(kHeight - 1, kWidth - 1), luminance_at(kWidth - 1, kHeight - 1));
}

TEST(GreyDecoder, DecodesJpegOfTheAnnouncedSizeOnly) {
  const std::vector<std::uint8_t> jpeg = as_jpeg(smooth_texture(64, 48, 5));
  GreyDecoder decoder;
  cv::Mat grey;
  ASSERT_TRUE(decoder.decode({PixelFormat::kJpeg, 64, 48, 0, jpeg}, grey));
  EXPECT_EQ(grey.size(), cv::Size(64, 48));
  EXPECT_FALSE(decoder.decode({PixelFormat::kJpeg, 48, 64, 0, jpeg}, grey));
}

}  // namespace
}  // namespace handeye
