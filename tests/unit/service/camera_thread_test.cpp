// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/camera_thread.hpp"

#include <deque>
#include <mutex>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace handeye {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr milliseconds kLong{10'000};

CameraModel model_640x480() {
  return {.width = 640, .height = 480, .fx = 500, .fy = 500, .cx = 320, .cy = 240};
}

/// What happens to a camera, told by the test from another thread; then nothing more happens.
class Script {
 public:
  struct Step {
    GrabStatus status{GrabStatus::kFrame};
    cv::Size size{640, 480};
  };
  void add(const Step& step, int times = 1) {
    const std::scoped_lock lock(mutex_);
    steps_.insert(steps_.end(), static_cast<std::size_t>(times), step);
  }
  std::optional<Step> next() {
    const std::scoped_lock lock(mutex_);
    if (steps_.empty()) {
      ++grabs_without_step;
      return std::nullopt;
    }
    const Step step = steps_.front();
    steps_.pop_front();
    return step;
  }
  std::atomic<bool> plugged_in{true};
  std::atomic<int> grabs_without_step{0};
  std::atomic<int> openings{0};

 private:
  std::mutex mutex_;
  std::deque<Step> steps_;
};

class ScriptedCamera final : public Camera {
 public:
  explicit ScriptedCamera(Script& script) : script_(script) {}

  std::optional<std::string> open() override {
    if (!script_.plugged_in) return "/dev/endoscope0: not there";
    ++counters_.opened;
    ++script_.openings;
    return std::nullopt;
  }
  void close() override {}
  GrabStatus grab(Frame& frame, milliseconds timeout) override {
    const auto step = script_.next();
    if (!step) {
      std::this_thread::sleep_for(std::min(timeout, milliseconds(5)));
      return GrabStatus::kTimeout;
    }
    if (step->status != GrabStatus::kFrame) return step->status;
    frame.grey.create(step->size, CV_8UC1);
    frame.timestamp_ns = 1000 + frames_;
    frame.sequence = static_cast<std::uint32_t>(frames_++);
    ++counters_.received;
    return GrabStatus::kFrame;
  }
  std::string description() const override { return "/dev/endoscope0"; }
  CameraCounters counters() const override {
    CameraCounters counters = counters_;
    counters.dropped_queue = 5;
    return counters;
  }

 private:
  Script& script_;
  CameraCounters counters_;
  std::int64_t frames_{0};
};

class CameraThreadTest : public testing::Test {
 protected:
  void start() {
    thread_.emplace(std::make_unique<ScriptedCamera>(script_), model_640x480(),
                    [this](const FrameStamp&) { ++stamps_; });
    thread_->start();
  }
  template <typename Condition>
  static void wait_until(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + kLong;
    while (!condition() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(milliseconds(1));
    }
  }
  /// The state, once it is this one.
  std::pair<std::int32_t, std::string> state_after(std::int32_t state) {
    wait_until([&] { return thread_->health().state().first == state; });
    return thread_->health().state();
  }
  void expect_frame(std::uint32_t sequence) {
    Frame* frame = thread_->frames().take(kLong);
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->sequence, sequence);
    thread_->frames().release(frame);
  }

  Script script_;
  std::atomic<int> stamps_{0};
  std::optional<CameraThread> thread_;
};

TEST_F(CameraThreadTest, HandsFramesOnInOrder) {
  start();
  for (std::uint32_t i = 0; i < 100; ++i) {
    script_.add({});
    expect_frame(i);
  }
  EXPECT_EQ(stamps_, 100);
  EXPECT_EQ(thread_->health().state().first, device_status_t::STREAMING);
  EXPECT_GT(thread_->health().last_ns, 0);
}

TEST_F(CameraThreadTest, CountsWhatTheConsumerDoesNotTake) {
  start();
  script_.add({}, 20);
  wait_until([&] { return stamps_ == 20; });
  // The counters follow with the grabs after it.
  const int before = script_.grabs_without_step;
  wait_until([&] { return script_.grabs_without_step > before + 1; });
  EXPECT_EQ(stamps_, 20) << "every frame has been there";
  int waiting = 0;
  while (Frame* frame = thread_->frames().take(milliseconds(0))) {
    thread_->frames().release(frame);
    ++waiting;
  }
  EXPECT_EQ(thread_->frames().dropped() + static_cast<std::uint64_t>(waiting), 20U);
  EXPECT_EQ(thread_->health().dropped_queue,
            5 + static_cast<std::int64_t>(thread_->frames().dropped()))
      << "what the driver dropped counts too";
}

TEST_F(CameraThreadTest, WaitsForACameraThatIsNotThere) {
  script_.plugged_in = false;
  start();
  EXPECT_THAT(state_after(device_status_t::ABSENT).second, HasSubstr("not there"));
  script_.plugged_in = true;
  script_.add({});
  expect_frame(0);
}

TEST_F(CameraThreadTest, OpensALostCameraAgain) {
  start();
  script_.add({});
  expect_frame(0);
  script_.add({GrabStatus::kLost});
  script_.add({});
  expect_frame(1);
  EXPECT_EQ(state_after(device_status_t::STREAMING).first, device_status_t::STREAMING);
  wait_until([&] { return thread_->health().restarts == 1; });
  EXPECT_EQ(thread_->health().restarts, 1);
}

/// A driver that is there, but fails: to open it again at once would be a loop without a rest.
TEST_F(CameraThreadTest, PausesEverLongerWhereACameraOpensButDeliversNothing) {
  script_.add({GrabStatus::kLost}, 10'000);
  const auto begun = std::chrono::steady_clock::now();
  start();
  EXPECT_THAT(state_after(device_status_t::ABSENT).second, HasSubstr("before its first frame"));
  wait_until([&] { return script_.openings >= 4; });
  EXPECT_EQ(script_.openings, 4) << "it does not give up";
  EXPECT_GE(std::chrono::steady_clock::now() - begun, milliseconds(250 + 500 + 1000));
}

TEST_F(CameraThreadTest, OpensACameraThatDeliveredAtOnceHoweverOftenItIsLost) {
  start();
  constexpr std::uint32_t kLosses = 40;
  const auto begun = std::chrono::steady_clock::now();
  for (std::uint32_t i = 0; i < kLosses; ++i) {
    script_.add({});
    expect_frame(i);
    script_.add({GrabStatus::kLost});
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, kLosses * milliseconds(250))
      << "no pause between";
}

TEST_F(CameraThreadTest, AFrameEndsTheGrowthOfThePauses) {
  script_.add({GrabStatus::kLost}, 3);
  script_.add({});
  start();
  expect_frame(0);
  script_.add({GrabStatus::kLost}, 2);
  script_.add({});
  const auto begun = std::chrono::steady_clock::now();
  expect_frame(1);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, milliseconds(1900))
      << "0.25 s, not the 2 s that would be next";
}

TEST_F(CameraThreadTest, RefusesFramesOfAnotherSizeAndSaysBoth) {
  start();
  script_.add({.size = {1280, 720}}, 3);
  const auto [state, text] = state_after(device_status_t::FAILED);
  EXPECT_EQ(state, device_status_t::FAILED);
  EXPECT_THAT(text, HasSubstr("1280x720"));
  EXPECT_THAT(text, HasSubstr("640x480"));
  EXPECT_EQ(thread_->frames().take(milliseconds(50)), nullptr);
  EXPECT_EQ(stamps_, 0);
}

TEST_F(CameraThreadTest, TakesTheRightSizeAgainAfterAWrongOne) {
  start();
  script_.add({});
  expect_frame(0);
  script_.add({.size = {1280, 720}});
  EXPECT_EQ(state_after(device_status_t::FAILED).first, device_status_t::FAILED);
  script_.add({});
  expect_frame(2);
  EXPECT_EQ(state_after(device_status_t::STREAMING).first, device_status_t::STREAMING);
  script_.add({.size = {1280, 720}});
  EXPECT_EQ(state_after(device_status_t::FAILED).first, device_status_t::FAILED) << "again";
}

}  // namespace
}  // namespace handeye
