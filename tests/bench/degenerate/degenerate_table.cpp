// SPDX-License-Identifier: BSD-3-Clause
// Scenes and motions that do not suffice, or hardly, over seeds: what is answered, and how often
// wrongly. degenerate_table [SEEDS [SECONDS [SCENE...]]]; ends with 1 where an answer was wrong.
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/unit/session/degenerate_scenes.hpp"

namespace {

using namespace handeye::degenerate;

struct Count {
  int accepted{0};
  int wrong{0};
};

Count over_seeds(const Scene& scene, std::uint64_t seeds, double duration_s) {
  Count count;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Trial trial = run(scene, seed, duration_s);
    const bool right = is_right(scene, trial);
    if (trial.accepted()) ++count.accepted;
    if (!right) ++count.wrong;
    fmt::print("{:<24} seed {:>3}: {}{}\n", scene.name, seed, describe(trial),
               right ? "" : "   WRONG");
    std::fflush(stdout);
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::uint64_t seeds = arguments.empty() ? 5 : std::stoull(arguments[0]);
  const double duration_s = arguments.size() < 2 ? 12.0 : std::stod(arguments[1]);
  std::vector<const Scene*> chosen;
  for (std::size_t i = 2; i < arguments.size(); ++i) chosen.push_back(&scene(arguments[i]));
  if (chosen.empty()) {
    for (const Scene& each : scenes()) chosen.push_back(&each);
  }
  int wrong = 0;
  std::string table;
  for (const Scene* each : chosen) {
    const Count count = over_seeds(*each, seeds, duration_s);
    wrong += count.wrong;
    table += fmt::format("{:<24} {:>3} accepted, {:>3} wrong of {}\n", each->name, count.accepted,
                         count.wrong, seeds);
  }
  fmt::print("\n{}", table);
  return wrong > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
