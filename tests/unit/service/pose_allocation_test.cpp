// SPDX-License-Identifier: BSD-3-Clause
// Nothing is allocated for a sample of the hand or a frame once the poses flow. A program of its
// own, in which everything that is allocated is counted. What LCM allocates to send a message is
// LCM's, and is measured by sending the like without a PosePublisher.
#include <cmath>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>

#include "daemon/service/pose_publisher.hpp"
#include "tests/unit/counted_allocations.hpp"

namespace handeye {
namespace {

using test::allocations;
using test::counts_allocations;

using std::chrono::milliseconds;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kStart_ns = 1'000'000 * kMillisecond_ns;
constexpr std::int64_t kSamplePeriod_ns = 16 * kMillisecond_ns;
constexpr std::int64_t kFramePeriod_ns = 40 * kMillisecond_ns;
constexpr int kFirstFrames = 50;  ///< in which the memory is taken
constexpr int kFrames = 400;

/// A hand that sways, seen at 60 Hz, and frames at 25 Hz; each frame's pose goes to a bus that
/// nobody else hears.
class PoseMemory : public testing::Test {
 protected:
  PoseMemory() {
    bus_.subscribe<camera_pose_t>("CAMERA_POSE", [this](const camera_pose_t& pose) {
      ++heard_;
      predicted_ += (pose.flags & camera_pose_t::FLAG_PREDICTED) != 0 ? 1 : 0;
      valid_ += pose.validity == camera_pose_t::VALID ? 1 : 0;
    });
    ActiveCalibration calibration;
    calibration.request_id = 77;
    calibration.covariance = Matrix6d::Identity();
    calibration.time_offset_sigma_s = 1e-3;
    calibration.hand_noise = {.rotation_rad = 0.001, .translation_mm = 0.15};
    publisher_.use(calibration);
  }

  void SetUp() override {
    if (!counts_allocations()) GTEST_SKIP() << "the sanitizer's allocator is in place";
    of_lcm_ = of_sending();
    RecordProperty("allocations_of_lcm", std::to_string(of_lcm_));
  }

  /// What each frame, with the samples before it, allocates beyond LCM's own, the first ones left
  /// out. The tracker's samples reach the publisher `late_ns` after they were taken; every so many
  /// are hidden, 0: none.
  std::vector<std::int64_t> per_frame(std::int64_t late_ns, int hidden_every = 0) {
    std::vector<std::int64_t> counts;
    counts.reserve(kFrames);
    for (int frame = 0; frame < kFrames; ++frame) {
      const std::int64_t frame_ns = kStart_ns + frame * kFramePeriod_ns;
      const std::int64_t now_ns = frame_ns + 20 * kMillisecond_ns;
      const std::int64_t before = allocations();

      for (; next_sample_ns_ + late_ns <= now_ns; next_sample_ns_ += kSamplePeriod_ns) {
        add_hand(hidden_every > 0 && ++samples_ % hidden_every == 0);
      }
      publisher_.hear({77, status_t::WATCH_HOLDS + frame % 2});
      publisher_.add_frame({frame_ns, frame, frame_ns});
      static_cast<void>(publisher_.due_ns(now_ns));
      publisher_.publish_ready(now_ns);
      const std::int64_t count = allocations() - before;
      if (frame >= kFirstFrames) counts.push_back(count - of_lcm_);
      while (bus_.handle(milliseconds(0))) {
      }
    }
    return counts;
  }

  int heard_{0};
  int valid_{0};
  int predicted_{0};

 private:
  void add_hand(bool hidden) {
    const double time_s = 1e-9 * static_cast<double>(next_sample_ns_ - kStart_ns);
    HandSample sample;
    sample.timestamp_ns = next_sample_ns_;
    sample.tracked = !hidden;
    sample.room_from_hand.linear() = exp_so3({0.3 * std::sin(time_s), 0.2, 0.1 * std::cos(time_s)});
    sample.room_from_hand.translation() << 100 * std::sin(time_s), 20, 300;
    publisher_.add_hand(sample);
  }

  /// One pose, without a PosePublisher.
  std::int64_t of_sending() {
    Bus bus("memq://");
    bus.subscribe<camera_pose_t>("CAMERA_POSE", [](const camera_pose_t&) {});
    Publisher<camera_pose_t> publisher(bus, "CAMERA_POSE");
    camera_pose_t pose{};
    std::int64_t count = 0;
    for (int i = 0; i < kFirstFrames; ++i) {
      const std::int64_t before = allocations();
      publisher.publish(pose);
      count = allocations() - before;
      while (bus.handle(milliseconds(0))) {
      }
    }
    return count;
  }

  Bus bus_{"memq://"};
  PosePublisher publisher_{bus_, "CAMERA_POSE"};
  std::int64_t next_sample_ns_{kStart_ns - 500 * kMillisecond_ns};
  int samples_{0};
  std::int64_t of_lcm_{0};
};

TEST_F(PoseMemory, IsNotTakenForAnInterpolatedPose) {
  EXPECT_THAT(per_frame(0), testing::Each(0));
  EXPECT_EQ(heard_, kFrames);
  EXPECT_EQ(valid_, kFrames);
  EXPECT_EQ(predicted_, 0);
}

TEST_F(PoseMemory, IsNotTakenForAPredictedPose) {
  EXPECT_THAT(per_frame(45 * kMillisecond_ns), testing::Each(0));
  EXPECT_EQ(heard_, kFrames);
  EXPECT_GT(predicted_, kFrames / 2);
}

TEST_F(PoseMemory, IsNotTakenForAHiddenHand) {
  EXPECT_THAT(per_frame(0, 3), testing::Each(0));
  EXPECT_EQ(heard_, kFrames);
  EXPECT_LT(valid_, kFrames / 2);
}

TEST_F(PoseMemory, IsCounted) {
  const std::int64_t before = allocations();
  const std::vector<int> memory(1000);
  EXPECT_EQ(memory.size(), 1000U);
  EXPECT_GT(allocations() - before, 0);
}

}  // namespace
}  // namespace handeye
