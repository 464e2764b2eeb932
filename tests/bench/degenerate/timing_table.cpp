// SPDX-License-Identifier: BSD-3-Clause
// What goes wrong with the devices' time and data, over seeds: what is answered, and how often
// wrongly. timing_table [SEEDS [SECONDS [WIDTH HEIGHT [SCENE...]]]]; ends with 1 where an answer
// was wrong.
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/unit/session/timing_scenes.hpp"

namespace {

using namespace handeye::timing;
using Clock = std::chrono::steady_clock;

struct Count {
  int accepted{0};
  int wrong{0};
};

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::uint64_t seeds = arguments.empty() ? 5 : std::stoull(arguments[0]);
  const double duration_s = arguments.size() < 2 ? 12.0 : std::stod(arguments[1]);
  const int width = arguments.size() < 4 ? 320 : std::stoi(arguments[2]);
  const int height = arguments.size() < 4 ? 240 : std::stoi(arguments[3]);
  std::vector<const Scene*> chosen;
  for (std::size_t i = 4; i < arguments.size(); ++i) chosen.push_back(&scene(arguments[i]));
  if (chosen.empty()) {
    for (const Scene& each : scenes()) chosen.push_back(&each);
  }
  std::map<std::string_view, Count> counts;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Footage footage(seed, duration_s, width, height);
    for (const Scene* each : chosen) {
      const auto begin = Clock::now();
      const Trial trial = run(*each, footage);
      const std::chrono::duration<double> took = Clock::now() - begin;
      const bool right = is_right(*each, trial);
      if (trial.accepted()) ++counts[each->name].accepted;
      if (!right) ++counts[each->name].wrong;
      fmt::print("{:<22} seed {:>3}: {}, {:.1f} s{}\n", each->name, seed, describe(trial),
                 took.count(), right ? "" : "   WRONG");
      std::fflush(stdout);
    }
  }
  int wrong = 0;
  fmt::print("\n");
  for (const Scene* each : chosen) {
    const Count& count = counts[each->name];
    wrong += count.wrong;
    fmt::print("{:<22} {:>3} accepted, {:>3} wrong of {}\n", each->name, count.accepted,
               count.wrong, seeds);
  }
  return wrong > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
