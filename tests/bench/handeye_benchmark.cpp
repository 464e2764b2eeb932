// SPDX-License-Identifier: BSD-3-Clause
// What each hand-eye method costs beside the seed's Table 1, whose times include the selection of
// the movements; so do these. Fails when one takes more than a tenth of the seed's time.
#include <algorithm>
#include <array>
#include <benchmark/benchmark.h>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "daemon/handeye/selection.hpp"
#include "daemon/handeye/types.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace {

using handeye::HandEyeProblem;
using handeye::Method;
using handeye::PosePair;
using handeye::ScaleMode;

/// Athlon XP 2600+ (Schmidt 2005, Table 1), selection included.
struct SeedTime {
  std::string_view method;
  double art1_ms;  ///< 190 images
  double art2_ms;  ///< 200 images
};
constexpr std::array<SeedTime, 5> kSeedTimes{{{"dq_scale_separate", 310, 433},
                                              {"horaud_scale_separate", 2090, 1590},
                                              {"nonlinear_quaternion", 2350, 1770},
                                              {"nonlinear_dual_quaternion", 756, 482},
                                              {"andreff", 309, 434}}};
constexpr double kFastest_ms = 309;  ///< the measure of methods that the table does not have

double seed_ms(ScaleMode scale, std::string_view method, int images) {
  for (const SeedTime& time : kSeedTimes) {
    if (scale == ScaleMode::kUnknown && time.method == method) {
      return images == 190 ? time.art1_ms : time.art2_ms;
    }
  }
  return kFastest_ms;
}

std::vector<PosePair> sequence(ScaleMode scale, int images) {
  const double units_per_mm = scale == ScaleMode::kKnown ? 1.0 : 0.02;
  return handeye::synthetic::record(handeye::synthetic::scope(units_per_mm),
                                    handeye::synthetic::free_hand, images,
                                    handeye::synthetic::tracker_and_camera(), 1)
      .poses();
}

void select(benchmark::State& state, int images) {
  const auto poses = sequence(ScaleMode::kUnknown, images);
  while (state.KeepRunning()) benchmark::DoNotOptimize(handeye::select_movements(poses));
}

void residuals(benchmark::State& state, int images) {
  const auto poses = sequence(ScaleMode::kUnknown, images);
  const auto solution = handeye::synthetic::scope(0.02).solution;
  while (state.KeepRunning()) benchmark::DoNotOptimize(handeye::seed_residuals(poses, solution));
}

/// From the poses to the answer.
void select_and_solve(benchmark::State& state, ScaleMode scale, const Method& method, int images) {
  const auto poses = sequence(scale, images);
  while (state.KeepRunning()) {
    const auto selection = handeye::select_movements(poses);
    const auto solution = method.solve({.poses = poses, .movements = selection.movements});
    if (!solution) {
      state.SkipWithError("no solution");
      break;
    }
    benchmark::DoNotOptimize(solution);
  }
  const double seed = seed_ms(scale, method.name, images);
  state.counters["seed_ms"] = seed;
  state.counters["tenth_ms"] = seed / 10;
}

/// The method alone.
void solve(benchmark::State& state, ScaleMode scale, const Method& method, int images) {
  const auto poses = sequence(scale, images);
  const auto selection = handeye::select_movements(poses);
  const HandEyeProblem problem{.poses = poses, .movements = selection.movements};
  while (state.KeepRunning()) benchmark::DoNotOptimize(method.solve(problem));
  state.SetLabel(fmt::format("{} movements", selection.movements.size()));
}

template <typename Function, typename... Arguments>
void add(const std::string& name, Function function, const Arguments&... arguments) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { function(state, arguments...); })
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime();  // of all threads: a second core must not flatter
}

void add_all() {
  for (const int images : {190, 200}) {
    add(fmt::format("select_movements/{}", images), select, images);
    add(fmt::format("seed_residuals/{}", images), residuals, images);
  }
  for (const ScaleMode scale : {ScaleMode::kKnown, ScaleMode::kUnknown}) {
    for (const Method& method : handeye::methods(scale)) {
      const auto name =
          fmt::format("{}/{}", scale == ScaleMode::kKnown ? "known" : "unknown", method.name);
      for (const int images : {190, 200}) {
        add(fmt::format("{}/{}", name, images), select_and_solve, scale, method, images);
      }
      add(fmt::format("{}/190/without_selection", name), solve, scale, method, 190);
    }
  }
}

/// The usual table, and which entries were slower than a tenth of the seed's time or failed.
class TenthOfTheSeed : public benchmark::ConsoleReporter {
 public:
  TenthOfTheSeed() : ConsoleReporter(OO_None) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      const auto tenth = run.counters.find("tenth_ms");
      const bool slow = tenth != run.counters.end() && run.GetAdjustedCPUTime() > tenth->second;
      if (run.error_occurred || slow) too_slow_.push_back(run.benchmark_name());
    }
  }
  const std::vector<std::string>& too_slow() const { return too_slow_; }

 private:
  std::vector<std::string> too_slow_;
};

}  // namespace

int main(int argc, char** argv) {
  // Enough for milliseconds, and some fifty entries should not take minutes; the caller's own
  // option comes later and wins.
  std::string min_time = "--benchmark_min_time=0.1";
  std::vector<char*> arguments(argv, argv + argc);
  arguments.insert(arguments.begin() + 1, min_time.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;
  add_all();
  TenthOfTheSeed reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  for (const std::string& name : reporter.too_slow()) {
    fmt::print(stderr, "{}: more than a tenth of the seed's time, or no solution\n", name);
  }
  return reporter.too_slow().empty() ? 0 : 3;
}
