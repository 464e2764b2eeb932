// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_camera.hpp"

#include <cerrno>
#include <ctime>
#include <poll.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "protocol/bus.hpp"
#include "tests/unit/v4l2/fake_device.hpp"

namespace handeye {
namespace {

constexpr std::chrono::milliseconds kWait(20);

class V4l2CameraTest : public testing::Test {
 protected:
  V4l2CameraTest() { options_.device = kFakePath; }

  void open() {
    camera_.emplace(options_);
    ASSERT_EQ(camera_->open(), std::nullopt);
  }

  std::string reason() {
    camera_.emplace(options_);
    return camera_->open().value_or("opened");
  }

  /// YUYV bytes of an even image.
  std::vector<std::uint8_t> yuyv(std::uint8_t luminance) const {
    const std::size_t stride = fake_.width * 2 + fake_.padding_bytes;
    std::vector<std::uint8_t> bytes(stride * fake_.height, 128);
    for (std::size_t y = 0; y < fake_.height; ++y) {
      for (std::size_t x = 0; x < fake_.width; ++x) bytes[y * stride + 2 * x] = luminance;
    }
    return bytes;
  }

  /// A frame, stamped a millisecond after the one before.
  FakeFrame frame(std::uint32_t sequence) {
    FakeFrame frame;
    frame.sequence = sequence;
    frame.stamp_ns = last_stamp_ns_ += 1'000'000;
    frame.bytes = yuyv(static_cast<std::uint8_t>(sequence + 50));
    return frame;
  }

  void expect_frame(std::uint32_t sequence) {
    ASSERT_EQ(camera_->grab(grabbed_, kWait), GrabStatus::kFrame);
    EXPECT_EQ(grabbed_.sequence, sequence);
    const cv::Size size(static_cast<int>(fake_.width), static_cast<int>(fake_.height));
    ASSERT_EQ(grabbed_.grey.size(), size);
    const cv::Mat expected(size, CV_8UC1, cv::Scalar(static_cast<std::uint8_t>(sequence + 50)));
    EXPECT_EQ(cv::norm(grabbed_.grey, expected, cv::NORM_INF), 0);
  }

  FakeDevice fake_;
  V4l2CameraOptions options_;
  std::optional<V4l2Camera> camera_;
  Frame grabbed_;
  std::int64_t last_stamp_ns_{monotonic_ns() / 1000 * 1000 - 100'000'000};
};

TEST_F(V4l2CameraTest, HandsOutFramesAndReusesItsBuffers) {
  fake_.padding_bytes = 6;
  open();
  EXPECT_EQ(camera_->description(), std::string(kFakePath) + " 16x8 YUYV 25.0 Hz");
  for (std::uint32_t sequence = 0; sequence < 20; ++sequence) {
    const std::int64_t before_ns = monotonic_ns();
    fake_.frames.push_back(frame(sequence));
    expect_frame(sequence);
    EXPECT_EQ(grabbed_.timestamp_ns, last_stamp_ns_);
    EXPECT_GE(grabbed_.arrival_ns, before_ns);
  }
  EXPECT_EQ(camera_->grab(grabbed_, kWait), GrabStatus::kTimeout);
  const CameraCounters counters = camera_->counters();
  EXPECT_EQ(counters.received, 20U);
  EXPECT_EQ(counters.dropped, 0U);
  EXPECT_EQ(counters.malformed, 0U);
  EXPECT_EQ(counters.opened, 1U);
}

TEST_F(V4l2CameraTest, TakesTheFirstPlaneOfMultiplanarDevices) {
  fake_.device_caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  fake_.formats = {V4L2_PIX_FMT_NV12M};
  open();
  FakeFrame sent;
  sent.sequence = 4;
  sent.bytes.assign(fake_.width * fake_.height, 54);
  fake_.frames.push_back(sent);
  expect_frame(4);
}

TEST_F(V4l2CameraTest, DecodesJpegAndPassesOverDamagedOnes) {
  fake_.formats = {V4L2_PIX_FMT_MJPEG};
  open();
  FakeFrame sent;
  sent.sequence = 1;
  cv::imencode(".jpg", cv::Mat(8, 16, CV_8UC1, cv::Scalar(52)), sent.bytes);
  FakeFrame cut = sent;
  cut.bytes.resize(cut.bytes.size() / 2);
  sent.sequence = 2;
  fake_.frames = {cut, sent};
  expect_frame(2);
  EXPECT_EQ(camera_->counters().malformed, 1U);
}

TEST_F(V4l2CameraTest, CountsDropsAcrossTheWrap) {
  open();
  for (const std::uint32_t sequence : {0xFFFF'FFFEU, 0xFFFF'FFFFU, 2U, 2U, 5U}) {
    fake_.frames.push_back(frame(sequence));
  }
  for (int i = 0; i < 5; ++i) ASSERT_EQ(camera_->grab(grabbed_, kWait), GrabStatus::kFrame);
  EXPECT_EQ(camera_->counters().dropped, 4U);
}

TEST_F(V4l2CameraTest, PassesOverFramesTheDriverCallsDamaged) {
  open();
  FakeFrame damaged = frame(1);
  damaged.flags |= V4L2_BUF_FLAG_ERROR;
  FakeFrame incomplete = frame(2);
  incomplete.bytes.resize(incomplete.bytes.size() - 1);
  FakeFrame empty = frame(3);
  empty.bytes.clear();
  fake_.frames = {damaged, incomplete, empty, frame(4)};
  expect_frame(4);
  EXPECT_EQ(camera_->counters().malformed, 3U);
  EXPECT_EQ(camera_->counters().dropped, 0U);
}

TEST_F(V4l2CameraTest, PassesOverFramesThatGoBackInTime) {
  open();
  FakeFrame first = frame(1);
  first.stamp_ns = monotonic_ns();
  FakeFrame again = first;
  again.sequence = 2;
  fake_.frames = {first, again};
  expect_frame(1);
  EXPECT_EQ(camera_->grab(grabbed_, kWait), GrabStatus::kTimeout);
  EXPECT_EQ(camera_->counters().malformed, 1U);
}

/// However the device fails, everything is given up, and it comes back clean.
class V4l2Loss : public V4l2CameraTest {
 protected:
  void expect_lost_and_found() {
    EXPECT_EQ(camera_->grab(grabbed_, kWait), GrabStatus::kLost);
    EXPECT_EQ(fake_.mapped(), 0U);
    EXPECT_EQ(camera_->description(), kFakePath);
    EXPECT_EQ(camera_->grab(grabbed_, kWait), GrabStatus::kLost);
    fake_.poll_events = 0;
    fake_.failing_request = 0;
    fake_.frames.clear();
    fake_.reset_stream();
    ASSERT_EQ(camera_->open(), std::nullopt);
    fake_.frames.push_back(frame(0));
    expect_frame(0);
    EXPECT_EQ(camera_->counters().opened, 2U);
    EXPECT_EQ(camera_->counters().dropped, 0U);
  }
};

TEST_F(V4l2Loss, IsNoticedWhenUnplugged) {
  open();
  fake_.poll_events = POLLERR | POLLHUP | POLLPRI;
  expect_lost_and_found();
}

TEST_F(V4l2Loss, IsNoticedWhenBuffersCannotBeTaken) {
  for (const int error : {ENODEV, EIO}) {
    open();
    fake_.frames.push_back(frame(0));
    fake_.failing_request = VIDIOC_DQBUF;
    fake_.failing_error = error;
    expect_lost_and_found();
    camera_.reset();
    fake_.reset_stream();
  }
}

TEST_F(V4l2Loss, IsNoticedWhenBuffersCannotBeGivenBack) {
  open();
  fake_.frames.push_back(frame(0));
  fake_.failing_request = VIDIOC_QBUF;
  fake_.failing_error = EINVAL;
  expect_lost_and_found();
}

TEST_F(V4l2Loss, IsNoticedWhenTheSignalChanges) {
  open();
  fake_.frames.push_back(frame(0));
  fake_.events = {V4L2_EVENT_CTRL, V4L2_EVENT_SOURCE_CHANGE};
  expect_lost_and_found();
}

/// Between the reading of its timings and the first frame nothing may be missed.
TEST_F(V4l2Loss, IsNoticedWhenTheSignalChangesWhileOpening) {
  fake_.signal_unsettled = true;
  open();
  fake_.frames.push_back(frame(0));
  fake_.signal_unsettled = false;
  expect_lost_and_found();
}

TEST_F(V4l2Loss, IsAssumedAfterSilence) {
  options_.silent_is_lost = std::chrono::milliseconds(0);
  open();
  expect_lost_and_found();
}

TEST_F(V4l2CameraTest, OtherEventsAreNoLoss) {
  open();
  fake_.frames.push_back(frame(0));
  fake_.events = {V4L2_EVENT_CTRL};
  expect_frame(0);
}

/// A driver that says for ever that there is a frame or an event, and there is none.
TEST_F(V4l2CameraTest, FalseAlarmsCostNoProcessorTime) {
  for (const short alarm : {short{POLLIN}, short{POLLPRI}}) {
    open();
    fake_.poll_events = alarm;
    const auto processor_s = [] {
      timespec time{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
      return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    };
    const double before_s = processor_s();
    EXPECT_EQ(camera_->grab(grabbed_, std::chrono::milliseconds(500)), GrabStatus::kTimeout);
    EXPECT_LT(processor_s() - before_s, 0.25) << "of half a second of waiting";
    fake_.poll_events = 0;
    camera_.reset();
    fake_.reset_stream();
  }
}

TEST_F(V4l2CameraTest, SaysWhyItCannotOpen) {
  const std::vector<std::tuple<unsigned long, int, std::string>> failures = {
      {VIDIOC_QUERYCAP, ENOTTY, "not a capture device"},
      {VIDIOC_QUERY_DV_TIMINGS, ENOLINK, "no signal"},
      {VIDIOC_S_FMT, EBUSY, "in use by another program"},
      {VIDIOC_REQBUFS, EBUSY, "in use by another program"},
      {VIDIOC_STREAMON, EIO, "cannot start the stream"},
      {VIDIOC_QBUF, EINVAL, "cannot queue a buffer"},
      {VIDIOC_STREAMON, ENODEV, "not there"},
  };
  for (const auto& [request, error, words] : failures) {
    fake_.failing_request = request;
    fake_.failing_error = error;
    EXPECT_THAT(reason(), testing::HasSubstr(words));
    EXPECT_EQ(fake_.mapped(), 0U) << words;
    fake_.reset_stream();
  }
}

TEST_F(V4l2CameraTest, RefusesDevicesThatDoNotCapture) {
  fake_.device_caps = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  EXPECT_EQ(reason(), std::string(kFakePath) + ": not a capture device");
  fake_.device_caps = V4L2_CAP_VIDEO_CAPTURE;
  EXPECT_EQ(reason(), std::string(kFakePath) + ": cannot stream");
}

TEST_F(V4l2CameraTest, RefusesWhatItCannotUse) {
  fake_.field = V4L2_FIELD_ALTERNATE;
  EXPECT_THAT(reason(), testing::HasSubstr("fields"));
  fake_.reset_stream();
  fake_.field = V4L2_FIELD_INTERLACED;
  EXPECT_EQ(reason(), "opened");
  EXPECT_THAT(camera_->description(), testing::EndsWith("interlaced"));
  camera_.reset();
  fake_.reset_stream();
  options_.wish.width = 1920;
  options_.wish.height = 1080;
  EXPECT_EQ(reason(), std::string(kFakePath) +
                          ": offers no 1920x1080 in GREY, YUYV, UYVY, NV12, JPEG; "
                          "configure a size it offers");
}

TEST_F(V4l2CameraTest, ClosesAndOpensAtAnyTime) {
  open();
  camera_->close();
  camera_->close();
  EXPECT_EQ(fake_.mapped(), 0U);
  EXPECT_EQ(camera_->grab(grabbed_, kWait), GrabStatus::kLost);
  fake_.reset_stream();
  ASSERT_EQ(camera_->open(), std::nullopt);
  EXPECT_EQ(fake_.mapped(), 4U);
  camera_.reset();
  EXPECT_EQ(fake_.mapped(), 0U);
}

}  // namespace
}  // namespace handeye
