// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/v4l2/v4l2_camera.hpp"
#include "tests/vm/guest/vivid.hpp"

namespace handeye {

/// Far longer than a frame takes, under emulation on a busy machine too.
inline constexpr std::chrono::milliseconds kPatience(5'000);

/// vivid as new, and our camera on it: its webcam at 320x180, 30 Hz, unless a test says otherwise.
class VividTest : public testing::Test {
 protected:
  VividTest() {
    renew_vivid();
    options_.device = kVivid;
    options_.wish.width = 320;
    options_.wish.height = 180;
    options_.wish.rate_hz = 30;
  }

  /// A new camera, opened; what it says when that fails.
  std::string opened() {
    camera_.emplace(options_);
    return camera_->open().value_or("opened");
  }

  /// The next frame; checks that it is whole, new and of the time it was taken.
  void grab_frame() {
    const Frame before{grabbed_.timestamp_ns, grabbed_.arrival_ns, grabbed_.sequence, {}};
    ASSERT_EQ(camera_->grab(grabbed_, kPatience), GrabStatus::kFrame);
    EXPECT_GT(grabbed_.timestamp_ns, before.timestamp_ns);
    EXPECT_GT(grabbed_.arrival_ns, before.arrival_ns);
    const std::int64_t age_ns = grabbed_.arrival_ns - grabbed_.timestamp_ns;
    // Four buffers' worth at most when this process was held up; the future is vivid's prediction.
    EXPECT_LT(age_ns, 2'000'000'000);
    EXPECT_GT(age_ns, -100'000'000);
  }

  std::vector<Frame> grab_frames(std::size_t count) {
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < count && !HasFatalFailure(); ++i) {
      grab_frame();
      frames.push_back(grabbed_);
      frames.back().grey = grabbed_.grey.clone();
    }
    return frames;
  }

  /// Grabs until the device counts as lost; false when frames go on for longer than 100.
  bool becomes_lost() {
    for (int i = 0; i < 100; ++i) {
      const GrabStatus status = camera_->grab(grabbed_, kPatience);
      if (status == GrabStatus::kLost) return true;
    }
    return false;
  }

  V4l2CameraOptions options_;
  std::optional<V4l2Camera> camera_;
  Frame grabbed_;
};

}  // namespace handeye
