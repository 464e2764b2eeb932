// SPDX-License-Identifier: BSD-3-Clause
// Time stamps and sequence numbers of a real kernel.
#include <linux/videodev2.h>
#include <sys/resource.h>
#include <vector>

#include "tests/vm/guest/raw_stamp.hpp"
#include "tests/vm/guest/vivid_fixture.hpp"

namespace handeye {
namespace {

class V4l2Time : public VividTest {
 protected:
  /// The next frame; its time must be the kernel's stamp, moved by so much.
  void grab_stamped(std::int64_t later_ns) {
    grab_frame();
    EXPECT_EQ(grabbed_.sequence, raw_stamp().sequence);
    EXPECT_EQ(grabbed_.timestamp_ns - raw_stamp().stamp_ns, later_ns);
  }

  static std::uint32_t kind_of_stamp() { return raw_stamp().flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK; }

  /// How many numbers lie between those of frames that follow each other. None where vivid gives
  /// two frames the same number: it counts periods by the kernel's ticks, and may wake up a tick
  /// early.
  static std::uint64_t missing_in(const std::vector<Frame>& frames) {
    std::uint64_t missing = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const std::uint32_t step = frames[i].sequence - frames[i - 1].sequence;
      if (step > 0) missing += step - 1;
    }
    return missing;
  }

  static double processor_s() {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }
};

TEST_F(V4l2Time, IsTheDriversWithoutAnExposureTime) {
  ASSERT_EQ(opened(), "opened");
  for (int i = 0; i < 30; ++i) {
    grab_stamped(0);
    EXPECT_GT(grabbed_.arrival_ns, grabbed_.timestamp_ns) << "the start of exposure is over";
  }
}

TEST_F(V4l2Time, IsTheMiddleOfExposureForEitherKindOfStamp) {
  options_.half_exposure_ns = 4'000'000;
  ASSERT_EQ(opened(), "opened");
  for (int i = 0; i < 5; ++i) grab_stamped(options_.half_exposure_ns);
  EXPECT_EQ(kind_of_stamp(), std::uint32_t{V4L2_BUF_FLAG_TSTAMP_SRC_SOE});
  camera_->close();
  // vivid's end of a frame lies ahead, by up to nine tenths of its period.
  set_menu("Timestamp Source", "End of Frame");
  grabbed_ = {};
  ASSERT_EQ(camera_->open(), std::nullopt);
  for (int i = 0; i < 5; ++i) grab_stamped(-options_.half_exposure_ns);
  EXPECT_EQ(kind_of_stamp(), std::uint32_t{V4L2_BUF_FLAG_TSTAMP_SRC_EOF});
  EXPECT_EQ(camera_->counters().malformed, 0U);
}

/// 1: near the end of 64 bits of nanoseconds; 2: near the end of 32 bits of seconds.
TEST_F(V4l2Time, IsThatOfArrivalWhenTheDriversHasWrapped) {
  for (const int kind : {1, 2}) {
    set_control("Wrap Timestamp", kind);
    ASSERT_EQ(opened(), "opened");
    for (const Frame& frame : grab_frames(10)) {
      EXPECT_EQ(frame.arrival_ns, frame.timestamp_ns);
    }
    EXPECT_GT(std::abs(raw_stamp().stamp_ns / 2 - grabbed_.arrival_ns / 2), 5'000'000'000);
    EXPECT_EQ(camera_->counters().malformed, 0U);
    camera_.reset();
    grabbed_.timestamp_ns = 0;
  }
}

TEST_F(V4l2Time, CountsEveryDroppedFrame) {
  set_control("Percentage of Dropped Buffers", 30);
  ASSERT_EQ(opened(), "opened");
  const std::vector<Frame> frames = grab_frames(60);
  ASSERT_EQ(frames.size(), 60U);
  EXPECT_GT(missing_in(frames), 3U);
  EXPECT_EQ(camera_->counters().dropped, missing_in(frames));
  EXPECT_EQ(camera_->counters().malformed, 0U);
  EXPECT_EQ(camera_->counters().received, 60U);
}

TEST_F(V4l2Time, GoesOnWhereTheSequenceWraps) {
  set_control("Wrap Sequence Number", 1);
  ASSERT_EQ(opened(), "opened");
  // It begins 128 before the end.
  const std::vector<Frame> frames = grab_frames(150);
  ASSERT_EQ(frames.size(), 150U);
  EXPECT_GT(frames.front().sequence, 0xFFFF'FF00U);
  EXPECT_LT(frames.back().sequence, 0x100U);
  EXPECT_LT(missing_in(frames), 150U);
  EXPECT_EQ(camera_->counters().dropped, missing_in(frames));
}

TEST_F(V4l2Time, SpentWaitingCostsNoProcessorTime) {
  set_control("Percentage of Dropped Buffers", 100);
  ASSERT_EQ(opened(), "opened");
  const double before_s = processor_s();
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(camera_->grab(grabbed_, std::chrono::milliseconds(200)), GrabStatus::kTimeout);
  }
  EXPECT_LT(processor_s() - before_s, 0.2) << "of two seconds of waiting";
}

TEST_F(V4l2Time, WithoutAnyFrameIsALoss) {
  options_.silent_is_lost = std::chrono::milliseconds(1'000);
  ASSERT_EQ(opened(), "opened");
  EXPECT_EQ(grab_frames(2).size(), 2U);
  set_control("Percentage of Dropped Buffers", 100);
  EXPECT_TRUE(becomes_lost());
  set_control("Percentage of Dropped Buffers", 0);
  ASSERT_EQ(camera_->open(), std::nullopt);
  EXPECT_EQ(grab_frames(2).size(), 2U);
}

}  // namespace
}  // namespace handeye
