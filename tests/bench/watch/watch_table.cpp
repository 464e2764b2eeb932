// SPDX-License-Identifier: BSD-3-Clause
// How the watch over a calibration does: watch_table [SEEDS [MINUTES [FIRST_SEED [SCENE...]]]].
// Heads that were turned or moved, beside what an ideal watch would have made of them, then
// unchanged ones for MINUTES each, over SEEDS seeds; of all scenes, or those whose name begins with
// one of the words ("tilt 1 deg every").
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tests/bench/watch/ideal_watch.hpp"
#include "tests/unit/session/watch_scene.hpp"

namespace handeye::test {
namespace {

constexpr double kPatience_s = 120.0;
constexpr double kNever = std::numeric_limits<double>::infinity();

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Unchanged {
  std::string_view name;
  void (*apply)(WatchSceneOptions& options);
};

const std::array<Unchanged, 6> kUnchanged{{
    {"everything", [](WatchSceneOptions&) {}},
    {"0.3 px, 25 Hz", [](WatchSceneOptions& o) { o.noise_px = 0.3, o.rate_hz = 25; }},
    {"0.5 px, drift 0.05", [](WatchSceneOptions& o) { o.noise_px = 0.5, o.drift_px = 0.05; }},
    {"pivots, turns, one axis, sliding",
     [](WatchSceneOptions& o) {
       o.motions = {MotionKind::kPivot, MotionKind::kTurning, MotionKind::kOneAxis,
                    MotionKind::kSliding};
     }},
    {"small and trembling",
     [](WatchSceneOptions& o) {
       o.motions = {MotionKind::kSmall, MotionKind::kTrembling, MotionKind::kPause};
     }},
    {"slow errors 0.06 deg, 0.15 mm",
     [](WatchSceneOptions& o) { o.hand_slow_deg = 0.06, o.hand_slow_mm = 0.15; }},
}};

void watch_unchanged(const Unchanged& scene, unsigned first, unsigned seeds, double minutes) {
  int doubtful = 0, broken = 0;
  double holding_s = 0, all_s = 0, looks = 0, largest_deg = 0;
  const double began_s = now_s();
  for (unsigned seed = first; seed < first + seeds; ++seed) {
    WatchSceneOptions options{.seed = seed};
    scene.apply(options);
    WatchScene world(options);
    CalibrationWatch watch(world.calibration());
    bool any_doubt = false, any_break = false;
    while (world.time_s() < 60.0 * minutes) {
      const WatchStatus status = watch.status(world.next(watch));
      any_doubt |= status.state == WatchState::kDoubtful;
      any_break |= status.state == WatchState::kBroken;
      holding_s += status.state == WatchState::kHolds ? 1.0 / options.rate_hz : 0.0;
      all_s += 1.0 / options.rate_hz;
      largest_deg = std::max(largest_deg, status.deviation_deg);
    }
    looks += watch.looks();
    doubtful += any_doubt ? 1 : 0;
    broken += any_break ? 1 : 0;
  }
  const double spent_s = now_s() - began_s;
  fmt::print(
      "unchanged  {:34} {:3} x {:.0f} min: broken {}, doubtful {}, holds {:.0f} % of the "
      "time, largest deviation {:.2f} deg, {:.1f} ms a look and all else\n",
      scene.name, seeds, minutes, broken, doubtful, 100.0 * holding_s / all_s, largest_deg,
      1e3 * spent_s / looks);
}

struct Changed {
  std::string_view name;
  Eigen::Vector3d turn_deg;
  Eigen::Vector3d shift_mm;
};

/// What became of one turned head: seconds of motion since.
struct Turned {
  std::optional<double> said_s;   ///< until it was said to be broken
  std::optional<double> ideal_s;  ///< until the ideal watch would have said so
  bool early{false};              ///< said before it was turned
};

Turned watch_turned(const WatchSceneOptions& options) {
  WatchScene world(options);
  CalibrationWatch watch(world.calibration());
  IdealWatch ideal(world.calibration());
  Turned turned;
  while ((!turned.said_s || !turned.ideal_s) &&
         world.time_s() < options.turned_at_s + kPatience_s) {
    const WatchStatus status = watch.status(world.next(watch));
    if (!turned.said_s && status.state == WatchState::kBroken) {
      turned.said_s = world.moved_since_turn_s();
      turned.early = world.time_s() < options.turned_at_s;
    }
    if (turned.ideal_s || world.time_s() < options.turned_at_s + options.turning_s) continue;
    ideal.see(world);
    if (ideal.fires()) turned.ideal_s = world.moved_since_turn_s();
  }
  return turned;
}

/// Sorted; what never came counts as infinite.
double quantile(std::vector<double> delays_s, double share) {
  std::ranges::sort(delays_s);
  return delays_s[static_cast<std::size_t>(share * static_cast<double>(delays_s.size() - 1))];
}

void watch_changed(const Changed& change, std::vector<MotionKind> motions, std::string_view how,
                   unsigned first, unsigned seeds) {
  std::vector<double> said_s, ideal_s, behind_s;
  int early = 0;
  const double began_s = now_s();
  for (unsigned seed = first; seed < first + seeds; ++seed) {
    WatchSceneOptions options{.seed = seed};
    options.motions = motions;
    options.turned_at_s = 20.0 + 0.37 * (seed - first);
    options.turn_deg = change.turn_deg;
    options.shift_mm = change.shift_mm;
    const Turned turned = watch_turned(options);
    early += turned.early ? 1 : 0;
    said_s.push_back(turned.said_s.value_or(kNever));
    ideal_s.push_back(turned.ideal_s.value_or(kNever));
    behind_s.push_back(turned.ideal_s ? said_s.back() - ideal_s.back() : 0.0);
  }
  const auto within = [](const std::vector<double>& delays_s, double most_s) {
    return std::ranges::count_if(delays_s, [&](double delay_s) { return delay_s <= most_s; });
  };
  fmt::print(
      "{:16} {:6}: {:2}/{} within 10 s of motion, ideally {:2}; median {:4.1f} s, slowest {:4.1f} "
      "s, ideally {:4.1f} s and {:4.1f} s; {:2} within 10 s of the ideal; too early {} ({:.0f} "
      "s)\n",
      change.name, how, within(said_s, 10.0), seeds, within(ideal_s, 10.0), quantile(said_s, 0.5),
      quantile(said_s, 1.0), quantile(ideal_s, 0.5), quantile(ideal_s, 1.0), within(behind_s, 10.0),
      early, now_s() - began_s);
}

}  // namespace
}  // namespace handeye::test

int main(int argc, char** argv) {
  using namespace handeye::test;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const auto seeds = static_cast<unsigned>(argc > 1 ? std::atoi(argv[1]) : 20);
  const double minutes = argc > 2 ? std::atof(argv[2]) : 30.0;
  const auto first = static_cast<unsigned>(argc > 3 ? std::atoi(argv[3]) : 1000);
  const std::span<char*> names(argv + std::min(argc, 4), argv + argc);
  const auto wanted = [&](std::string_view scene) {
    return names.empty() ||
           std::ranges::any_of(names, [&](const char* name) { return scene.starts_with(name); });
  };
  using Eigen::Vector3d;
  const std::vector<Changed> changes{
      {"roll 5 deg", {0, 0, 5}, {0, 0, 0}},     {"tilt 1 deg", {1, 0, 0}, {0, 0, 0}},
      {"turn 1 deg", {0, 1, 0}, {0, 0, 0}},     {"roll 2 deg", {0, 0, 2}, {0, 0, 0}},
      {"roll 45 deg", {0, 0, 45}, {0, 0, 0}},   {"roll 90 deg", {0, 0, 90}, {0, 0, 0}},
      {"roll 180 deg", {1, 0, 179}, {0, 0, 0}}, {"tilt 12 deg", {12, 3, 0}, {2, 0, 0}},
      {"mounted anew", {1, 1, 140}, {1, 2, 4}}};
  for (const Changed& change : changes) {
    if (wanted(fmt::format("{} free", change.name))) {
      watch_changed(change, {MotionKind::kFree}, "free", first, seeds);
    }
    if (wanted(fmt::format("{} every", change.name))) {
      watch_changed(change, {kEveryMotion.begin(), kEveryMotion.end()}, "every", first, seeds);
    }
  }
  for (const Unchanged& scene : kUnchanged) {
    if (wanted(scene.name)) watch_unchanged(scene, first, seeds, minutes);
  }
}
