// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_modes.hpp"

#include <linux/videodev2.h>

#include <gtest/gtest.h>

namespace handeye {
namespace {

// A USB camera whose cable is too narrow for uncompressed images of full size.
const std::vector<V4l2Mode> kUsbCamera = {
    {V4L2_PIX_FMT_MJPEG, 1920, 1080, 30}, {V4L2_PIX_FMT_MJPEG, 640, 480, 60},
    {V4L2_PIX_FMT_YUYV, 1920, 1080, 5},   {V4L2_PIX_FMT_YUYV, 640, 480, 30},
    {V4L2_PIX_FMT_RGB24, 640, 480, 120},
};

V4l2Wish wish(int width, int height, double rate_hz) {
  V4l2Wish wish;
  wish.width = width;
  wish.height = height;
  wish.rate_hz = rate_hz;
  return wish;
}

std::string chosen(const std::vector<V4l2Mode>& modes, const V4l2Wish& wish) {
  const auto mode = choose_mode(modes, wish);
  return mode ? fourcc_text(mode->fourcc) : "none";
}

TEST(ChooseMode, PrefersRawFormatsWhileTheyAreFastEnough) {
  EXPECT_EQ(chosen(kUsbCamera, wish(640, 480, 30)), "YUYV");
  EXPECT_EQ(chosen(kUsbCamera, wish(640, 480, 0)), "YUYV");
}

TEST(ChooseMode, TakesJpegWhereTheRawFormatIsTooSlow) {
  EXPECT_EQ(chosen(kUsbCamera, wish(640, 480, 60)), "MJPG");
  EXPECT_EQ(chosen(kUsbCamera, wish(1920, 1080, 25)), "MJPG");
}

TEST(ChooseMode, TakesTheFastestWhenNoneIsFastEnough) {
  EXPECT_EQ(chosen(kUsbCamera, wish(1920, 1080, 60)), "MJPG");
}

TEST(ChooseMode, TakesVideoRatesForWhatIsMeant) {
  EXPECT_EQ(chosen({{V4L2_PIX_FMT_MJPEG, 64, 48, 60}, {V4L2_PIX_FMT_YUYV, 64, 48, 30000 / 1001.0}},
                   wish(64, 48, 30)),
            "YUYV");
}

TEST(ChooseMode, RefusesOtherSizesAndUnknownFormats) {
  EXPECT_EQ(chosen(kUsbCamera, wish(1280, 720, 30)), "none");
  EXPECT_EQ(chosen({{V4L2_PIX_FMT_RGB24, 640, 480, 30}}, wish(640, 480, 30)), "none");
  EXPECT_EQ(chosen({}, wish(640, 480, 30)), "none");
}

TEST(ChooseMode, AcceptsDevicesThatDoNotTellSizesOrRates) {
  EXPECT_EQ(chosen({{V4L2_PIX_FMT_UYVY, 0, 0, 0}}, wish(1920, 1080, 60)), "UYVY");
}

TEST(ChooseMode, KeepsTheOrderOfTheWish) {
  const std::vector<V4l2Mode> all = {{V4L2_PIX_FMT_MJPEG, 64, 48, 30},
                                     {V4L2_PIX_FMT_NV12, 64, 48, 30},
                                     {V4L2_PIX_FMT_UYVY, 64, 48, 30},
                                     {V4L2_PIX_FMT_YUYV, 64, 48, 30},
                                     {V4L2_PIX_FMT_GREY, 64, 48, 30}};
  V4l2Wish wanted = wish(64, 48, 30);
  for (const char* const expected : {"GREY", "YUYV", "UYVY", "NV12", "MJPG"}) {
    EXPECT_EQ(chosen(all, wanted), expected);
    wanted.formats.erase(wanted.formats.begin());
  }
  EXPECT_EQ(chosen(all, wanted), "none");
}

TEST(Fourcc, IsReadable) {
  EXPECT_EQ(fourcc_text(V4L2_PIX_FMT_NV12), "NV12");
  EXPECT_EQ(fourcc_text(0x01020304), "????");
}

}  // namespace
}  // namespace handeye
