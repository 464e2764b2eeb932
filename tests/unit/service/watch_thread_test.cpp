// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/watch_thread.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/bus.hpp"
#include "tests/unit/session/watch_scene.hpp"

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using Words = std::vector<std::pair<std::int64_t, WatchState>>;

constexpr std::chrono::seconds kPatience{120};

/// The threads about the watch: feeds a scope whose head is turned after some seconds, as fast as
/// it is taken, and collects what is told.
class WatchThreadTest : public testing::Test {
 protected:
  WatchThreadTest() { watch_.start(); }

  void begin(std::int64_t request_id) {
    watched_ = request_id;
    watch_.watch(request_id, scene_.calibration());
  }

  /// Stamped ahead of the monotonic clock, by which ages are: a slow machine makes none old.
  void feed_frame() {
    scene_.next({.add_hand =
                     [&](HandSample sample) {
                       sample.timestamp_ns += began_ns_;
                       hand_.push({watched_, sample});
                       if (with_another_hand_) push_another(sample);
                     },
                 .add_frame =
                     [&](const TrackedFrame& frame) {
                       TrackedItem* item = tracked_.acquire();
                       while (item == nullptr) {
                         std::this_thread::sleep_for(milliseconds(2));
                         item = tracked_.acquire();
                       }
                       item->calibration = 1;
                       item->frame = frame;
                       item->frame.timestamp_ns += began_ns_;
                       tracked_.commit(item);
                     }});
  }

  /// As of a body that a former calibration was of.
  void push_another(HandSample sample) {
    sample.timestamp_ns += 3'000'000;
    sample.room_from_hand.translation() += Eigen::Vector3d(200, -100, 50);
    hand_.push({watched_ - 1, sample});
  }

  /// Feeds on until that was told of it, or until patience is out.
  bool feed_until_told(std::int64_t request_id, WatchState state) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::ranges::count(words(), std::pair(request_id, state)) == 0) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      feed_frame();
    }
    return true;
  }

  Words words() {
    const std::scoped_lock lock(mutex_);
    return words_;
  }

  std::int64_t began_ns_{monotonic_ns() + 3'600'000'000'000};
  WatchScene scene_{
      {.seed = 8, .motions = {MotionKind::kFree}, .turned_at_s = 20, .turn_deg = {0, 0, 5}}};
  std::mutex mutex_;
  Words words_;
  BoundedQueue<WatchedHand> hand_{1024};
  std::int64_t watched_{0};
  bool with_another_hand_{false};
  Exchange<TrackedItem> tracked_{4};
  WatchThread watch_{hand_, tracked_, [this](std::int64_t request_id, WatchState state) {
                       const std::scoped_lock lock(mutex_);
                       words_.emplace_back(request_id, state);
                     }};
};

TEST_F(WatchThreadTest, TellsEveryChangeOfTheCalibrationInUse) {
  begin(7);
  ASSERT_TRUE(feed_until_told(7, WatchState::kBroken));
  const Words expected{{7, WatchState::kUnchecked},
                       {7, WatchState::kHolds},
                       {7, WatchState::kDoubtful},
                       {7, WatchState::kBroken}};
  EXPECT_EQ(words(), expected);
  const WatchStatus status = watch_.status(monotonic_ns());
  EXPECT_EQ(status.state, WatchState::kBroken);
  EXPECT_GT(status.deviation_deg, 1);
}

/// At first frames of before the turn are among those looked at, and make it look smaller.
TEST_F(WatchThreadTest, TellsHowFarOnceTheTurnIsPast) {
  begin(7);
  ASSERT_TRUE(feed_until_told(7, WatchState::kBroken));
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  const auto off_deg = [&] { return std::abs(watch_.status(monotonic_ns()).deviation_deg - 5); };
  while (off_deg() > 0.5 && std::chrono::steady_clock::now() < deadline) feed_frame();
  EXPECT_LT(off_deg(), 0.5);
  EXPECT_EQ(watch_.status(monotonic_ns()).state, WatchState::kBroken);
}

TEST_F(WatchThreadTest, NeverTellsOfACalibrationThatIsNoLongerInUse) {
  begin(7);
  ASSERT_TRUE(feed_until_told(7, WatchState::kBroken));
  begin(8);
  const std::size_t told = words().size();
  EXPECT_NE(watch_.status(monotonic_ns()).state, WatchState::kBroken) << "not yet of this one";
  ASSERT_TRUE(feed_until_told(8, WatchState::kBroken)) << "the head is turned against both";
  const Words all = words();
  for (std::size_t i = told; i < all.size(); ++i) EXPECT_EQ(all[i].first, 8);
  EXPECT_EQ(all[told].second, WatchState::kUnchecked);
}

TEST_F(WatchThreadTest, TakesNoHandOfAnotherCalibration) {
  with_another_hand_ = true;
  begin(7);
  ASSERT_TRUE(feed_until_told(7, WatchState::kHolds));
  const Words expected{{7, WatchState::kUnchecked}, {7, WatchState::kHolds}};
  EXPECT_EQ(words(), expected);
}

}  // namespace
}  // namespace handeye::test
