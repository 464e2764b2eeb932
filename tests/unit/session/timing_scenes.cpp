// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/timing_scenes.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "daemon/session/calibration.hpp"
#include "daemon/session/hand_stream.hpp"
#include "daemon/session/image_stage.hpp"
#include "drivers/simulator/endoscope_view.hpp"
#include "drivers/simulator/tracker_link.hpp"

namespace handeye::timing {
namespace {

using simulator::camera_fault;
using simulator::SimulatorOptions;
using simulator::tracker_fault;
using simulator::World;

constexpr std::int64_t kStartNs = 1'000'000'000'000;

// The tracker's datagrams are late by a jitter of 1 ms in the mean; where they carry no time, that
// mean is part of the offset, and the rest of it noise.
constexpr double kJitter_s = 0.001;

template <const char* kFault>
void of_tracker(World& world) {
  world.tracker_faults.push_back(tracker_fault(kFault));
}

template <const char* kFault>
void of_camera(World& world) {
  world.camera_faults.push_back(camera_fault(kFault));
}

constexpr char kOcclusion[] = "occlusion@5=2";
constexpr char kLost[] = "lost";
constexpr char kReordered[] = "reordered";
constexpr char kDuplicated[] = "duplicated";
constexpr char kBursts[] = "bursts";
constexpr char kJumpAhead[] = "clock-jump@6=0.3";
constexpr char kJumpBack[] = "clock-jump@6=-0.3";
constexpr char kJumpAnHour[] = "clock-jump@6=3600";
constexpr char kSmallJump[] = "clock-jump@6=0.03";
constexpr char kStall[] = "stall@6=0.5";
constexpr char kStampsAhead[] = "stamp-jump@6=0.3";
constexpr char kStampsBack[] = "stamp-jump@6=-0.3";

void day_ends(World& world) {
  world.tracker_clock_start_s = 86400.0 - 6.0;
}

const std::array<Scene, 17> kScenes{{
    {"undisturbed", [](World&) {}, {}},
    {"occlusion", of_tracker<kOcclusion>, {}},
    {"lost_datagrams", of_tracker<kLost>, {}},
    {"reordered", of_tracker<kReordered>, {}},
    {"duplicated", of_tracker<kDuplicated>, {}},
    {"bursts", of_tracker<kBursts>, {}},
    {"clock_ahead", of_tracker<kJumpAhead>, {Reason::kClockUnstable}},
    {"clock_back", of_tracker<kJumpBack>, {Reason::kClockUnstable}},
    {"clock_an_hour_ahead", of_tracker<kJumpAnHour>, {Reason::kClockUnstable}},
    {"clock_a_little_ahead", of_tracker<kSmallJump>, {Reason::kClockUnstable, Reason::kUncertain}},
    {"midnight", day_ends, {}},
    {"ts2_midnight",
     [](World& world) {
       day_ends(world);
       world.options.timestamps = simulator::Timestamps::kUnixTime;
     },
     {}},
    {"no_time", [](World& world) { world.options.timestamps = simulator::Timestamps::kNone; }, {}},
    {"lost_frames", [](World& world) { world.options.disturbances.missing_share = 0.08; }, {}},
    {"stall", of_camera<kStall>, {}},
    // What is left contradicts itself and looks like a bad motion, but for the offsets of its
    // halves.
    {"stamps_ahead", of_camera<kStampsAhead>, {Reason::kClockUnstable}},
    {"stamps_back", of_camera<kStampsBack>, {Reason::kClockUnstable}},
}};

SimulatorOptions options_of(std::uint64_t seed, int width, int height) {
  return {.seed = seed, .width = width, .height = height};
}

/// The tracker's side, taken in as far as time has come.
class Datagrams {
 public:
  Datagrams(const World& world, double duration_s)
      : link_(world), stream_(0), duration_s_(duration_s) {
    link_.next(next_);
  }

  void feed_until(std::int64_t arrival_ns, Calibration& calibration) {
    for (; next_.measured_s < duration_s_ && next_.arrival_ns <= arrival_ns; link_.next(next_)) {
      const auto sample = stream_.take({next_.arrival_ns, next_.bytes});
      if (sample) calibration.add_hand(*sample);
    }
  }

 private:
  simulator::TrackerLink link_;
  HandStream stream_;
  double duration_s_;
  simulator::SimulatedDatagram next_;
};

CalibrationResult calibrate(const World& world, const Footage& footage) {
  CalibrationOptions options;
  options.camera = world.camera;
  Calibration calibration(options);
  Datagrams datagrams(world, footage.duration_s);
  const auto images = make_image_stage(std::nullopt, {});
  const simulator::FrameFates fates(world.options.disturbances, world.options.seed,
                                    world.options.camera_rate_hz);
  const simulator::FrameDelivery delivery(world);
  Frame frame;
  TrackedFrame tracked;
  for (std::uint32_t number = 0; number < footage.pictures.size(); ++number) {
    const double exposed_s = number / world.options.camera_rate_hz;
    const auto arrival_ns = delivery.arrival_ns(exposed_s);
    if (!arrival_ns || fates.of(number).missing) continue;
    frame.sequence = number;
    frame.timestamp_ns = delivery.timestamp_ns(exposed_s);
    frame.arrival_ns = *arrival_ns;
    frame.grey = footage.pictures[number];
    datagrams.feed_until(*arrival_ns, calibration);
    images->process(frame, tracked);
    calibration.add_frame(tracked);
  }
  datagrams.feed_until(std::numeric_limits<std::int64_t>::max(), calibration);
  return calibration.solve();
}

double true_offset_s(const World& world) {
  const bool timeless = world.options.timestamps == simulator::Timestamps::kNone;
  return world.time_offset_s() - (timeless ? kJitter_s : 0);
}

}  // namespace

Footage::Footage(std::uint64_t seed, double duration, int width, int height)
    : world(options_of(seed, width, height), kStartNs), duration_s(duration) {
  simulator::EndoscopeView view(world);
  const auto frames =
      static_cast<std::uint32_t>(std::ceil(duration_s * world.options.camera_rate_hz));
  for (std::uint32_t number = 0; number < frames; ++number) {
    pictures.emplace_back();
    view.draw(number, pictures.back());
  }
}

std::span<const Scene> scenes() {
  return kScenes;
}

const Scene& scene(std::string_view name) {
  return trial::scene_named<World>(name, kScenes);
}

Trial run(const Scene& scene, const Footage& footage) {
  World world = footage.world;
  scene.apply(world);
  Trial trial{trial::against(world.hand_from_eye, calibrate(world, footage))};
  if (!trial.result.has_estimate) return trial;
  trial.time_offset_error_s =
      std::abs(trial.result.time_offset_s.value_or(0) - true_offset_s(world));
  return trial;
}

bool is_right(const Scene& scene, const Trial& trial) {
  return trial.accepted() ? trial.is_honest() : trial.refused_for_any(scene.reasons);
}

std::string describe(const Trial& trial) {
  return fmt::format("{}, {:.2f} ms (sigma {:.2f})", trial::describe(trial),
                     1e3 * trial.time_offset_error_s,
                     1e3 * trial.result.time_offset_sigma_s.value_or(0));
}

}  // namespace handeye::timing
