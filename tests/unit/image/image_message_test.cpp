// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/image/image_message.hpp"

#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handeye {
namespace {

image_t grey_image() {
  image_t image{};
  image.timestamp_ns = 5'000'000'000;
  image.frame_number = 17;
  image.width = 8;
  image.height = 4;
  image.pixel_format = image_t::GREY8;
  image.stride = 10;
  image.size = 40;
  image.data.assign(40, 9);
  image.num_features = 2;
  image.feature_x_px = {1.5F, 2.5F};
  image.feature_y_px = {3.5F, 4.5F};
  return image;
}

std::vector<std::uint8_t> encoded(const image_t& image) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(image.getEncodedSize()));
  image.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

int decode(CheckedImage& image, const std::vector<std::uint8_t>& bytes) {
  return image.decode(bytes.data(), 0, static_cast<int>(bytes.size()));
}

/// Overwrites a big-endian int32.
void put_int32(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  }
}

constexpr std::size_t kSizeAt = 64;                    // of `size` in an encoded image_t
constexpr std::size_t kFeaturesAt = kSizeAt + 4 + 40;  // of `num_features` in grey_image()

TEST(CheckedImage, DecodesWhatTheGeneratedCodeEncodes) {
  const image_t sent = grey_image();
  const std::vector<std::uint8_t> bytes = encoded(sent);
  CheckedImage received;
  ASSERT_EQ(decode(received, bytes), static_cast<int>(bytes.size()));
  EXPECT_EQ(received.timestamp_ns, sent.timestamp_ns);
  EXPECT_EQ(received.data, sent.data);
  EXPECT_EQ(received.feature_y_px, sent.feature_y_px);
}

TEST(CheckedImage, DecodesAtAnOffset) {
  std::vector<std::uint8_t> bytes = encoded(grey_image());
  bytes.insert(bytes.begin(), 3, 0xAA);
  CheckedImage received;
  EXPECT_GT(received.decode(bytes.data(), 3, static_cast<int>(bytes.size()) - 3), 0);
  EXPECT_EQ(received.width, 8);
}

TEST(CheckedImage, RefusesEveryMessageCutShort) {
  const std::vector<std::uint8_t> bytes = encoded(grey_image());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CheckedImage received;
    EXPECT_LT(
        decode(received, {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}), 0)
        << length;
  }
}

TEST(CheckedImage, RefusesFalseLengthsBeforeItAllocates) {
  for (const std::size_t at : {kSizeAt, kFeaturesAt}) {
    for (const std::uint32_t lie : {0xFFFFFFFFU, 0x80000000U, 0x7FFFFFFFU, 1000U}) {
      std::vector<std::uint8_t> bytes = encoded(grey_image());
      put_int32(bytes, at, lie);
      CheckedImage received;
      EXPECT_LT(decode(received, bytes), 0) << at << " " << lie;
      EXPECT_LE(received.data.capacity() + received.feature_x_px.capacity(), 1000U);
    }
  }
}

TEST(CheckedImage, RefusesAnotherType) {
  std::vector<std::uint8_t> bytes = encoded(grey_image());
  bytes[0] ^= 1;  // the fingerprint
  CheckedImage received;
  EXPECT_LT(decode(received, bytes), 0);
}

TEST(ImageProblem, SaysNothingAboutGoodImages) {
  image_t image = grey_image();
  EXPECT_EQ(image_problem(image), std::nullopt);
  image.size = 38;  // without the last row's padding
  EXPECT_EQ(image_problem(image), std::nullopt);
  image.pixel_format = image_t::JPEG;
  image.stride = 0;
  image.size = 1;
  EXPECT_EQ(image_problem(image), std::nullopt);
}

TEST(ImageProblem, NamesTheFieldThatIsWrong) {
  const std::vector<std::pair<std::string, std::function<void(image_t&)>>> mistakes = {
      {"timestamp_ns", [](image_t& image) { image.timestamp_ns = -1; }},
      {"frame_number", [](image_t& image) { image.frame_number = -1; }},
      {"width", [](image_t& image) { image.width = 0; }},
      {"width", [](image_t& image) { image.width = 16385; }},
      {"height", [](image_t& image) { image.height = -4; }},
      {"height", [](image_t& image) { image.height = 1 << 30; }},
      {"pixel_format", [](image_t& image) { image.pixel_format = 3; }},
      {"stride", [](image_t& image) { image.stride = 7; }},
      {"stride", [](image_t& image) { image.stride = 11; }},
      {"no image data", [](image_t& image) { image.size = 0; }},
      {"shorter", [](image_t& image) { image.size = 37; }},
  };
  for (const auto& [word, make] : mistakes) {
    image_t image = grey_image();
    make(image);
    EXPECT_THAT(image_problem(image).value_or(""), testing::HasSubstr(word));
  }
}

TEST(EncodedImageOfMessage, CarriesTheLayout) {
  const image_t image = grey_image();
  const EncodedImage layout = encoded_image(image);
  EXPECT_EQ(layout.format, PixelFormat::kGrey);
  EXPECT_EQ(layout.width, 8);
  EXPECT_EQ(layout.height, 4);
  EXPECT_EQ(layout.stride_bytes, 10);
  EXPECT_EQ(layout.bytes.data(), image.data.data());
  EXPECT_EQ(layout.bytes.size(), 40U);
}

}  // namespace
}  // namespace handeye
