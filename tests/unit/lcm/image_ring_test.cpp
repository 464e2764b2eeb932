// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lcm/image_ring.hpp"

#include <gtest/gtest.h>

namespace handeye {
namespace {

image_t numbered(std::int64_t number) {
  image_t image{};
  image.frame_number = number;
  image.size = 100;
  image.data.assign(100, static_cast<std::uint8_t>(number));
  return image;
}

TEST(ImageRing, GivesImagesInOrder) {
  ImageRing ring(3);
  EXPECT_EQ(ring.front(), nullptr);
  std::int64_t next = 0;
  for (std::int64_t pushed = 0; pushed < 20; ++pushed) {
    EXPECT_TRUE(ring.push(numbered(pushed), 1000 + pushed));
    if (pushed % 2 == 0) continue;
    for (; next <= pushed; ++next) {
      ASSERT_NE(ring.front(), nullptr);
      EXPECT_EQ(ring.front()->message.frame_number, next);
      EXPECT_EQ(ring.front()->message.data, numbered(next).data);
      EXPECT_EQ(ring.front()->arrival_ns, 1000 + next);
      ring.pop();
    }
    EXPECT_EQ(ring.front(), nullptr);
  }
}

TEST(ImageRing, GivesUpItsOldestWhenFull) {
  ImageRing ring(3);
  for (std::int64_t pushed = 0; pushed < 5; ++pushed) {
    EXPECT_EQ(ring.push(numbered(pushed), 0), pushed < 3);
  }
  for (std::int64_t expected = 2; expected < 5; ++expected) {
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(ring.front()->message.frame_number, expected);
    ring.pop();
  }
  EXPECT_EQ(ring.front(), nullptr);
}

TEST(ImageRing, IsEmptyAfterClear) {
  ImageRing ring(2);
  ring.push(numbered(1), 0);
  ring.clear();
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_TRUE(ring.push(numbered(2), 0));
  EXPECT_EQ(ring.front()->message.frame_number, 2);
}

}  // namespace
}  // namespace handeye
