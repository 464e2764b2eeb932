// SPDX-License-Identifier: BSD-3-Clause
// Everything that vivid can let go wrong, and what must come of it.
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include "protocol/bus.hpp"
#include "tests/vm/guest/vivid_fixture.hpp"

namespace handeye {
namespace {

using testing::HasSubstr;

class V4l2Failures : public VividTest {
 protected:
  /// The device works as if nothing had been, with nothing of the past.
  void expect_frames_again() {
    ASSERT_EQ(camera_->open(), std::nullopt);
    const std::int64_t opened_ns = monotonic_ns();
    const std::vector<Frame> frames = grab_frames(5);
    ASSERT_EQ(frames.size(), 5U);
    EXPECT_LT(frames[0].sequence, 100U);
    EXPECT_GT(frames[0].timestamp_ns, opened_ns - 100'000'000);
  }

  void expect_lost_and_found() {
    EXPECT_TRUE(becomes_lost());
    EXPECT_EQ(camera_->description(), options_.device);
    EXPECT_EQ(camera_->grab(grabbed_, kPatience), GrabStatus::kLost);
    expect_frames_again();
    EXPECT_EQ(camera_->counters().opened, 2U);
  }
};

TEST_F(V4l2Failures, DamagedFramesAreCountedAndPassedOver) {
  ASSERT_EQ(opened(), "opened");
  grab_frames(3);
  set_control("Inject V4L2_BUF_FLAG_ERROR", 1);
  const std::vector<Frame> frames = grab_frames(10);
  ASSERT_EQ(frames.size(), 10U);
  EXPECT_EQ(camera_->counters().malformed, 1U);
  EXPECT_EQ(camera_->counters().received, 13U);
}

TEST_F(V4l2Failures, FatalErrorOfTheStream) {
  ASSERT_EQ(opened(), "opened");
  grab_frames(3);
  set_control("Inject Fatal Streaming Error", 1);
  expect_lost_and_found();
}

TEST_F(V4l2Failures, StreamThatDoesNotStart) {
  set_control("Inject VIDIOC_STREAMON Error", 1);
  EXPECT_THAT(opened(), HasSubstr(std::string(kVivid) + ": cannot start the stream"));
  EXPECT_EQ(camera_->counters().opened, 0U);
  expect_frames_again();
}

TEST_F(V4l2Failures, NoBuffers) {
  set_control("Inject VIDIOC_REQBUFS Error", 1);
  EXPECT_THAT(opened(), HasSubstr(std::string(kVivid) + ": cannot get buffers"));
  expect_frames_again();
}

TEST_F(V4l2Failures, BufferThatIsNotTakenBack) {
  set_control("Inject VIDIOC_QBUF Error", 1);
  EXPECT_THAT(opened(), HasSubstr(std::string(kVivid) + ": cannot queue a buffer"));
  expect_frames_again();
  set_control("Inject VIDIOC_QBUF Error", 1);
  EXPECT_TRUE(becomes_lost());
  expect_frames_again();
}

TEST_F(V4l2Failures, UnpluggedAndPluggedIn) {
  ASSERT_EQ(opened(), "opened");
  grab_frames(3);
  set_control("Disconnect", 1);
  expect_lost_and_found();
}

TEST_F(V4l2Failures, UnpluggedAndPluggedInMultiplanar) {
  options_.device = kVividMultiplanar;
  ASSERT_EQ(opened(), "opened");
  grab_frames(3);
  set_control("Disconnect", 1, kVividMultiplanar);
  expect_lost_and_found();
}

TEST_F(V4l2Failures, DeviceNodeThatGoesAndComesBack) {
  for (int cycle = 0; cycle < 5; ++cycle) {
    ASSERT_EQ(opened(), "opened");
    grab_frames(2);
    set_control("Disconnect", 1);
    EXPECT_TRUE(becomes_lost());
    unload_vivid();
    EXPECT_EQ(camera_->open(), std::string(kVivid) + ": not there");
    load_vivid();
    expect_frames_again();
    camera_.reset();
    grabbed_.timestamp_ns = 0;
  }
}

TEST_F(V4l2Failures, DeviceOfAnotherProgram) {
  ASSERT_EQ(opened(), "opened");
  grab_frames(2);
  V4l2Camera second(options_);
  EXPECT_EQ(second.open(), std::string(kVivid) + ": in use by another program");
  EXPECT_EQ(grab_frames(5).size(), 5U) << "the first is not disturbed by it";
  camera_->close();
  EXPECT_EQ(second.open(), std::nullopt);
}

TEST_F(V4l2Failures, ForbiddenDevice) {
  std::filesystem::permissions(kVivid, std::filesystem::perms::owner_read);
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(seteuid(kNobody), 0);
  EXPECT_EQ(opened(), std::string(kVivid) + ": permission denied; add the user to the group video");
  ASSERT_EQ(seteuid(0), 0);
  expect_frames_again();
}

/// An HDMI grabber and the camera before it.
class V4l2Signal : public V4l2Failures {
 protected:
  /// Items of the menu "DV Timings Signal Mode". kOfTheMenu: as "DV Timings" says.
  enum Mode { kPresent = 0, kNone = 1, kUnstable = 2, kOutOfRange = 3, kOfTheMenu = 4 };

  V4l2Signal() {
    select_input(VividInput::kHdmi);
    options_.wish = {};  // the size is the signal's
  }

  static void set_signal(Mode mode) { set_control("DV Timings Signal Mode", mode); }
};

TEST_F(V4l2Signal, LostAndBack) {
  ASSERT_EQ(opened(), "opened");
  grab_frames(2);
  set_signal(kNone);
  EXPECT_TRUE(becomes_lost());
  EXPECT_THAT(camera_->open().value_or("opened"), HasSubstr("no signal"));
  set_signal(kUnstable);
  EXPECT_THAT(camera_->open().value_or("opened"), HasSubstr("unstable signal"));
  set_signal(kOutOfRange);
  EXPECT_THAT(camera_->open().value_or("opened"), HasSubstr("out of range"));
  set_signal(kPresent);
  expect_frames_again();
}

TEST_F(V4l2Signal, OfAnotherSizeIsTakenOver) {
  set_menu("DV Timings", "640x480p59");
  set_signal(kOfTheMenu);
  ASSERT_EQ(opened(), "opened");
  EXPECT_THAT(camera_->description(), HasSubstr(" 640x480 "));
  grab_frames(2);
  EXPECT_EQ(grabbed_.grey.size(), cv::Size(640, 480));
  set_menu("DV Timings", "1280x720p60");
  EXPECT_TRUE(becomes_lost());
  ASSERT_EQ(camera_->open(), std::nullopt);
  EXPECT_THAT(camera_->description(), HasSubstr(" 1280x720 "));
  grab_frames(2);
  EXPECT_EQ(grabbed_.grey.size(), cv::Size(1280, 720));
}

/// What stays behind must not grow.
class V4l2Endurance : public V4l2Failures {
 protected:
  struct Held {
    std::ptrdiff_t descriptors, threads;
    bool operator==(const Held&) const = default;
  };

  static Held held() {
    const auto entries = [](const char* folder) {
      return std::distance(std::filesystem::directory_iterator(folder), {});
    };
    return {entries("/proc/self/fd"), entries("/proc/self/task")};
  }

  /// Mappings of the device, from the kernel's own list.
  static int mapped() {
    std::ifstream maps("/proc/self/maps");
    int count = 0;
    for (std::string line; std::getline(maps, line);) {
      if (line.find("/dev/video") != std::string::npos) ++count;
    }
    return count;
  }
};

TEST_F(V4l2Endurance, ThousandTimesOpenedAndClosed) {
  ASSERT_EQ(opened(), "opened");
  EXPECT_EQ(mapped(), 4);
  camera_->close();
  const Held before = held();
  for (int cycle = 0; cycle < 1'000; ++cycle) {
    ASSERT_EQ(camera_->open(), std::nullopt) << cycle;
    camera_->close();
  }
  EXPECT_EQ(held(), before);
  EXPECT_EQ(mapped(), 0);
  expect_frames_again();
}

TEST_F(V4l2Endurance, TwoHundredTimesUnplugged) {
  ASSERT_EQ(opened(), "opened");
  camera_->close();
  const Held before = held();
  for (int cycle = 0; cycle < 200; ++cycle) {
    ASSERT_EQ(camera_->open(), std::nullopt) << cycle;
    set_control("Disconnect", 1);
    ASSERT_TRUE(becomes_lost()) << cycle;
  }
  EXPECT_EQ(held(), before);
  EXPECT_EQ(mapped(), 0);
  expect_frames_again();
}

}  // namespace
}  // namespace handeye
