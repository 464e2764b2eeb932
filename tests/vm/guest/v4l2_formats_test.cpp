// SPDX-License-Identifier: BSD-3-Clause
// What is agreed with a device, and that the image is the one the device took.
#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "tests/vm/guest/vivid_fixture.hpp"

namespace handeye {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class V4l2Formats : public VividTest {
 protected:
  /// One frame of a pattern of vivid's in a format.
  cv::Mat picture(const char* pattern, PixelFormat format) {
    set_menu("Test Pattern", pattern, options_.device.c_str());
    options_.wish.formats = {format};
    EXPECT_EQ(opened(), "opened");
    EXPECT_EQ(camera_->description(), options_.device + " 320x180 " + name_of(format) + " 30.0 Hz");
    grab_frame();
    EXPECT_EQ(camera_->counters().malformed, 0U);
    camera_.reset();
    grabbed_.timestamp_ns = 0;
    return grabbed_.grey.clone();
  }

  void expect_same_pictures() {
    const cv::Mat ramp = picture("Gray Ramp", PixelFormat::kGrey);
    ASSERT_EQ(ramp.size(), cv::Size(320, 180));
    double darkest = 0, brightest = 0;
    cv::minMaxLoc(ramp, &darkest, &brightest);
    EXPECT_LT(darkest, 5);
    EXPECT_GT(brightest, 250);
    // GREY has the full range; luminance beside colours has that of television, 16 to 235.
    cv::Mat expected;
    ramp.convertTo(expected, CV_8U, 219.0 / 255.0, 16);
    const cv::Mat bars = picture("75% Colorbar", PixelFormat::kYuyv);
    for (const PixelFormat format : {PixelFormat::kYuyv, PixelFormat::kUyvy, PixelFormat::kNv12}) {
      EXPECT_LE(cv::norm(picture("Gray Ramp", format), expected, cv::NORM_INF), 2)
          << name_of(format);
      EXPECT_EQ(cv::norm(picture("75% Colorbar", format), bars, cv::NORM_INF), 0)
          << name_of(format);
    }
  }
};

TEST_F(V4l2Formats, AllShowTheSamePicture) {
  EXPECT_EQ(driver_name(kVivid), "vivid");
  expect_same_pictures();
}

TEST_F(V4l2Formats, AllShowTheSamePictureMultiplanar) {
  options_.device = kVividMultiplanar;
  expect_same_pictures();
}

TEST_F(V4l2Formats, AreReadBackFromTheDevice) {
  for (const auto& [width, height, rate_hz] :
       {std::tuple{640, 360, 15.0}, {640, 480, 25.0}, {1280, 720, 10.0}}) {
    options_.wish.width = width;
    options_.wish.height = height;
    options_.wish.rate_hz = rate_hz;
    ASSERT_EQ(opened(), "opened");
    EXPECT_EQ(camera_->description(),
              fmt::format("{} {}x{} GREY {:.1f} Hz", kVivid, width, height, rate_hz));
    const VividSetting setting = setting_of(kVivid);
    EXPECT_EQ(fourcc_text(setting.fourcc), "GREY");
    EXPECT_EQ(std::tuple(setting.width, setting.height), std::tuple(width, height));
    EXPECT_NEAR(setting.rate_hz, rate_hz, 1e-6);
    grab_frame();
    EXPECT_EQ(grabbed_.grey.size(), cv::Size(width, height));
    camera_.reset();
    grabbed_.timestamp_ns = 0;
  }
}

TEST_F(V4l2Formats, OfNoSuchSizeAreRefusedInWords) {
  options_.wish.width = 321;
  EXPECT_THAT(opened(), HasSubstr("offers no 321x180"));
}

TEST_F(V4l2Formats, WithBothFieldsInOneImageAreTakenAndSaid) {
  select_input(VividInput::kTelevision);
  options_.wish = {};
  ASSERT_EQ(opened(), "opened");
  EXPECT_THAT(camera_->description(), EndsWith("interlaced"));
  EXPECT_EQ(grab_frames(3).size(), 3U);
}

/// Rows of a picture that moves sideways are alike, unless it was changed while it was copied.
TEST_F(V4l2Formats, NeverGiveHalfOrOldPictures) {
  set_control("Horizontal Movement", 5);
  for (const PixelFormat format : {PixelFormat::kGrey, PixelFormat::kYuyv}) {
    options_.wish.formats = {format};
    ASSERT_EQ(opened(), "opened");
    const std::vector<Frame> frames = grab_frames(30);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const cv::Mat& grey = frames[i].grey;
      const cv::Mat same_rows = cv::repeat(grey.row(0), grey.rows, 1);
      EXPECT_EQ(cv::norm(grey, same_rows, cv::NORM_INF), 0) << i;
      EXPECT_GT(cv::norm(grey, frames[i - 1].grey, cv::NORM_INF), 0) << i;
    }
    grabbed_.timestamp_ns = 0;
  }
}

}  // namespace
}  // namespace handeye
