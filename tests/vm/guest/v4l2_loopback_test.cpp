// SPDX-License-Identifier: BSD-3-Clause
// What vivid cannot be: a camera of motion JPEG, and one whose stamps name no clock.
#include <linux/videodev2.h>
#include <optional>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/vm/guest/loopback.hpp"
#include "tests/vm/guest/raw_stamp.hpp"
#include "tests/vm/guest/vivid_fixture.hpp"

namespace handeye {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr std::chrono::milliseconds kShown(500);  // what is written is there at once

/// A ramp from a grey level on: each differs from the others.
cv::Mat ramp(int from) {
  cv::Mat grey(kHeight, kWidth, CV_8UC1);
  for (int column = 0; column < kWidth; ++column) grey.col(column).setTo(from + column / 4);
  return grey;
}

Bytes jpeg(const cv::Mat& grey) {
  Bytes bytes;
  cv::imencode(".jpg", grey, bytes, {cv::IMWRITE_JPEG_QUALITY, 95});
  return bytes;
}

class V4l2Loopback : public testing::Test {
 protected:
  V4l2Loopback() {
    options_.device = Loopback::kDevice;
    options_.wish.width = kWidth;
    options_.wish.height = kHeight;
  }

  /// The device is a camera of this format once a picture was written; that one is not looked at.
  void open(std::uint32_t fourcc, const Bytes& first) {
    loopback_.emplace(fourcc, kWidth, kHeight);
    loopback_->write(first);
    camera_.emplace(options_);
    ASSERT_EQ(camera_->open().value_or("opened"), "opened");
    while (camera_->grab(frame_, kShown) == GrabStatus::kFrame) ++before_;
  }
  void TearDown() override { camera_.reset(); }

  /// What comes of what is written next: the next whole frame, or nothing.
  GrabStatus shown(const Bytes& bytes) {
    loopback_->write(bytes);
    return camera_->grab(frame_, kShown);
  }

  V4l2CameraOptions options_;
  std::optional<Loopback> loopback_;
  std::optional<V4l2Camera> camera_;
  Frame frame_;
  std::uint64_t before_{0};  ///< pictures, when the camera was opened
};

TEST_F(V4l2Loopback, ShowsMotionJpeg) {
  open(V4L2_PIX_FMT_MJPEG, jpeg(ramp(0)));
  EXPECT_EQ(driver_name(Loopback::kDevice), "v4l2 loopback");
  EXPECT_THAT(camera_->description(), testing::HasSubstr("320x240 JPEG"));
  for (const int from : {10, 80, 150}) {
    ASSERT_EQ(shown(jpeg(ramp(from))), GrabStatus::kFrame);
    EXPECT_LE(cv::norm(frame_.grey, ramp(from), cv::NORM_INF), 3);
  }
  EXPECT_EQ(camera_->counters().malformed, 0U);
}

TEST_F(V4l2Loopback, PassesOverDamagedMotionJpeg) {
  const Bytes whole = jpeg(ramp(40));
  open(V4L2_PIX_FMT_MJPEG, whole);
  ASSERT_EQ(shown(whole), GrabStatus::kFrame);
  const cv::Mat good = frame_.grey.clone();
  const std::int64_t good_ns = frame_.timestamp_ns;

  Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2));
  Bytes noise(4000, 0x5A);
  Bytes no_picture{0xFF, 0xD8, 0xFF, 0xD9};
  const Bytes other_size = jpeg(cv::Mat(kHeight / 2, kWidth, CV_8UC1, cv::Scalar(90)));
  std::uint64_t malformed = 0;
  for (const Bytes& damaged : {cut, noise, no_picture, other_size}) {
    EXPECT_EQ(shown(damaged), GrabStatus::kTimeout);
    EXPECT_EQ(camera_->counters().malformed, ++malformed);
  }
  // Nothing of them is left in what comes next.
  ASSERT_EQ(shown(whole), GrabStatus::kFrame);
  EXPECT_EQ(cv::norm(frame_.grey, good, cv::NORM_INF), 0);
  EXPECT_GT(frame_.timestamp_ns, good_ns);
  EXPECT_EQ(camera_->counters().received, before_ + 2U);
}

TEST_F(V4l2Loopback, BelievesStampsOfNoNamedClockThatFit) {
  const cv::Mat grey = ramp(20);
  const Bytes bytes(grey.begin<std::uint8_t>(), grey.end<std::uint8_t>());
  open(V4L2_PIX_FMT_GREY, bytes);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(shown(bytes), GrabStatus::kFrame);
    EXPECT_EQ(raw_stamp().flags & V4L2_BUF_FLAG_TIMESTAMP_MASK, V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN);
    EXPECT_EQ(frame_.timestamp_ns, raw_stamp().stamp_ns);
    EXPECT_GT(frame_.arrival_ns, frame_.timestamp_ns);
    EXPECT_EQ(cv::norm(frame_.grey, grey, cv::NORM_INF), 0);
  }
}

}  // namespace
}  // namespace handeye
