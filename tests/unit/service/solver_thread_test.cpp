// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/solver_thread.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "tests/unit/session/tracked_scene.hpp"

namespace handeye {
namespace {

using namespace tracked;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{60};
constexpr WantedSigma kOutOfReach{1e-6, 1e-6};
constexpr WantedSigma kWithinReach{0.3, 1.5};
constexpr int kPoints = 150;  // few: these tests are about threads

/// The threads about the solver: feeds both streams, about four times as fast as they are in life,
/// and collects what it says.
class LiveSolver {
 public:
  explicit LiveSolver(EyeMotion motion = free_motion)
      : scene_(std::move(motion), kPoints),
        solver_(hand_, tracked_,
                {.camera = kCamera,
                 .intrinsics = IntrinsicsMode::kFixed,
                 .noise = noise(),
                 .min_duration_s = 0.1}) {
    solver_.start();
  }

  void begin(std::int64_t request_id, const WantedSigma& wanted, double max_duration_s = 600) {
    solver_.begin({.request_id = request_id, .wanted = wanted, .max_duration_s = max_duration_s},
                  ++calibration_);
  }

  /// Of a hand that holds still, as if it had been pushed before the calibration that begins next.
  void feed_stale_hand(double duration_s) {
    const auto samples = static_cast<std::int64_t>(duration_s * kTrackerRate_hz);
    for (std::int64_t i = 0; i < samples; ++i) {
      HandSample sample = scene_.hand(samples_ + i);
      sample.room_from_hand = scene_.hand(samples_).room_from_hand;
      hand_.push({calibration_, sample});
    }
  }

  /// As much more of both streams.
  void feed(double duration_s) {
    const double until_s = fed_s_ + duration_s;
    for (; fed_s_ < until_s; fed_s_ = static_cast<double>(frames_) / kFrameRate_hz) {
      while (static_cast<double>(samples_) / kTrackerRate_hz < fed_s_ + 0.1) {
        hand_.push({calibration_, scene_.hand(samples_++)});
      }
      TrackedItem* item = tracked_.acquire();
      if (item == nullptr) {
        std::this_thread::sleep_for(milliseconds(5));
        continue;
      }
      item->calibration = calibration_;
      item->frame = scene_.frame(frames_++);
      tracked_.commit(item);
    }
  }

  /// Feeds on until then, or until patience is out.
  bool feed_until(const std::function<bool()>& condition) {
    const auto deadline = Clock::now() + kPatience;
    while (!condition()) {
      if (Clock::now() > deadline) return false;
      feed(0.2);
      std::this_thread::sleep_for(milliseconds(50));
    }
    return true;
  }

  /// Nothing: none in a long time.
  std::optional<CalibrationResult> result() {
    const auto deadline = Clock::now() + kPatience;
    while (Clock::now() < deadline && !has_result()) std::this_thread::sleep_for(milliseconds(5));
    return std::exchange(result_, std::nullopt);
  }

  bool has_result() {
    while (auto event = solver_.next_event()) {
      if (auto* result = std::get_if<CalibrationResult>(&*event)) {
        result_ = std::move(*result);
      } else {
        ++times_solving_;
      }
    }
    return result_.has_value();
  }

  /// Until it said so.
  bool is_solving() {
    const auto deadline = Clock::now() + kPatience;
    while (Clock::now() < deadline && times_solving_ == 0 && !has_result()) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    return times_solving_ > 0;
  }
  int times_solving() const { return times_solving_; }

  SolverThread& solver() { return solver_; }
  std::int64_t frames() const { return frames_; }

 private:
  static PoseNoise noise() {
    PoseNoise noise;
    noise.hand_rotation_rad = rad_from_deg(0.06);
    noise.hand_translation_mm = 0.15;
    return noise;
  }

  TrackedScene scene_;
  double fed_s_{0};
  std::int64_t samples_{0};
  std::int64_t frames_{0};
  std::uint64_t calibration_{0};
  std::optional<CalibrationResult> result_;
  int times_solving_{0};
  BoundedQueue<HandItem> hand_{8192};
  Exchange<TrackedItem> tracked_{64};
  SolverThread solver_;
};

void expect_true(const Pose& found, const MethodSigma& sigma) {
  const Pose truth = true_hand_from_eye();
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found.linear(), truth.linear())),
            3.5 * sigma.rotation_deg);
  EXPECT_LT((found.translation() - truth.translation()).norm(), 3.5 * sigma.translation_mm);
}

TEST(SolverThread, ShowsAnAnswerWhileItCollectsAndRefinesIt) {
  LiveSolver live;
  live.begin(1, kOutOfReach);
  const auto sigma = [&] { return live.solver().progress().provisional.sigma; };
  ASSERT_TRUE(live.feed_until([&] { return sigma().has_value(); }));
  const Provisional first = live.solver().progress().provisional;
  ASSERT_TRUE(first.solution);
  expect_true(first.solution->hand_from_eye, *first.sigma);
  ASSERT_TRUE(live.feed_until(
      [&] { return sigma() && sigma()->rotation_deg < 0.7 * first.sigma->rotation_deg; }));
  const CalibrationProgress later = live.solver().progress();
  expect_true(later.provisional.solution->hand_from_eye, *later.provisional.sigma);
  EXPECT_NE(later.guidance.code, GuideCode::kNone) << "the wanted sigma is out of reach";
}

TEST(SolverThread, EndsByItselfWhenTheWantedSigmaIsReached) {
  LiveSolver live;
  live.begin(7, kWithinReach);
  ASSERT_TRUE(live.feed_until([&] { return live.has_result(); }));
  const CalibrationResult result = *live.result();
  EXPECT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
  EXPECT_EQ(result.request_id, 7);
  EXPECT_LE(result.sigma_rotation_deg, kWithinReach.rotation_deg);
  EXPECT_LE(result.sigma_translation_mm, kWithinReach.translation_mm);
  expect_true(result.solution.hand_from_eye,
              {result.sigma_rotation_deg, result.sigma_translation_mm});
}

TEST(SolverThread, FinishTakesEveryFrameSoFarWhateverIsBeingSolved) {
  LiveSolver live;
  // Provisional answers are being solved one after the other.
  live.begin(2, kOutOfReach);
  ASSERT_TRUE(live.feed_until([&] { return live.solver().progress().provisional.frames > 0; }));
  live.feed(4);
  live.solver().finish();
  const auto result = live.result();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->frames.received, live.frames());
  EXPECT_EQ(result->verdict, Verdict::kRefused);
  EXPECT_TRUE(result->has_estimate);
  EXPECT_EQ(live.times_solving(), 1);
}

TEST(SolverThread, FinishTakesEveryFrameSoFarWhileAnAttemptIsUnderWay) {
  // The attempt may be done before it is asked to finish, then that ends the calibration.
  bool took_all = false;
  for (std::int64_t trial = 0; trial < 8 && !took_all; ++trial) {
    LiveSolver live;
    live.begin(20 + trial, kWithinReach);
    // With the provisional answer that shows it an attempt begins.
    ASSERT_TRUE(live.feed_until([&] {
      const auto sigma = live.solver().progress().provisional.sigma;
      return live.has_result() || (sigma && sigma->rotation_deg < kWithinReach.rotation_deg &&
                                   sigma->translation_mm < kWithinReach.translation_mm);
    }));
    if (live.has_result()) continue;
    live.solver().finish();
    const auto result = live.result();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->verdict, Verdict::kAccepted) << reason_word(result->reason);
    took_all = result->frames.received == live.frames();
    EXPECT_TRUE(took_all || live.times_solving() == 0) << "asked in time, but not all went in";
    EXPECT_LE(live.times_solving(), 1);
  }
  EXPECT_TRUE(took_all);
}

TEST(SolverThread, DropsWhatTheCalibrationBeforeLeftBehind) {
  LiveSolver live;
  live.feed_stale_hand(20);
  live.begin(8, kWithinReach);
  ASSERT_TRUE(live.feed_until([&] { return live.has_result(); }));
  const CalibrationResult result = *live.result();
  EXPECT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
  expect_true(result.solution.hand_from_eye,
              {result.sigma_rotation_deg, result.sigma_translation_mm});
}

TEST(SolverThread, RefusesAtTheTimeLimitWithTheReason) {
  LiveSolver live(one_axis_motion);
  live.begin(3, kWithinReach, 2.0);
  ASSERT_TRUE(live.feed_until([&] { return live.has_result(); }));
  const CalibrationResult result = *live.result();
  EXPECT_EQ(result.verdict, Verdict::kRefused);
  EXPECT_EQ(result.reason, Reason::kSingleAxis) << reason_word(result.reason);
  EXPECT_FALSE(result.advice.empty());
}

TEST(SolverThread, CancelDropsTheAnswerThatIsBeingSolvedAndTheNextCalibrationIsItsOwn) {
  LiveSolver live;
  live.begin(4, kOutOfReach);
  live.feed(6);
  live.solver().finish();
  ASSERT_TRUE(live.is_solving());
  live.solver().cancel();
  const auto cancelled = live.result();
  ASSERT_TRUE(cancelled);
  EXPECT_EQ(cancelled->verdict, Verdict::kCancelled);
  EXPECT_EQ(cancelled->request_id, 4);
  live.begin(5, kOutOfReach);
  live.feed(3);
  live.solver().finish();
  const auto next = live.result();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->request_id, 5);
  EXPECT_LE(next->frames.received, 3 * kFrameRate_hz + 1);
}

TEST(SolverThread, StopsWhileItSolves) {
  LiveSolver live;
  live.begin(6, kOutOfReach);
  live.feed(6);
  live.solver().finish();
  ASSERT_TRUE(live.is_solving());
}

TEST(BackgroundThread, RunsOneJobAfterTheOther) {
  BackgroundThread thread;
  EXPECT_FALSE(thread.busy());
  for (int i = 1; i <= 100; ++i) EXPECT_EQ(thread.run([i] { return i; }).get(), i);
}

TEST(BackgroundThread, EndsTheRunningJobWhoseAnswerNobodyWants) {
  std::atomic<bool> begun{false};
  std::atomic<bool> ended{false};
  {
    BackgroundThread thread;
    static_cast<void>(thread.run([&] {
      begun = true;
      std::this_thread::sleep_for(milliseconds(50));
      ended = true;
    }));
    EXPECT_TRUE(thread.busy());
    while (!begun) std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_TRUE(ended);
}

TEST(BackgroundThread, DoesNotBeginAJobThatWaitsWhenItEnds) {
  // The answer is there before the job and what it owns have gone: the next one has to wait.
  struct SlowToGo {
    ~SlowToGo() { std::this_thread::sleep_for(milliseconds(100)); }
  };
  std::atomic<bool> begun{false};
  {
    BackgroundThread thread;
    thread.run([owned = std::make_shared<SlowToGo>()] { return owned != nullptr; }).wait();
    static_cast<void>(thread.run([&] { begun = true; }));
  }
  EXPECT_FALSE(begun);
}

TEST(BackgroundThread, AFailedJobHasNoOutcome) {
  BackgroundThread thread;
  auto failing = thread.run([]() -> int { throw std::runtime_error("no"); });
  EXPECT_FALSE(outcome_of(failing, "this").has_value());
  auto working = thread.run([] { return 3; });
  EXPECT_EQ(outcome_of(working, "this"), 3);
}

TEST(BackgroundThread, HandsExceptionsOn) {
  BackgroundThread thread;
  auto answer = thread.run([]() -> int { throw std::runtime_error("no"); });
  EXPECT_THROW(answer.get(), std::runtime_error);
  EXPECT_EQ(thread.run([] { return 3; }).get(), 3);
}

}  // namespace
}  // namespace handeye
