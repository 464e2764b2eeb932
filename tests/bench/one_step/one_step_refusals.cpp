// SPDX-License-Identifier: BSD-3-Clause
// Motions that lack something, from nothing of it to enough, and what is said of them:
// one_step_refusals [SEEDS [MOTION]]; ends with 1 where an accepted answer was off by more than 3.5
// of its own standard deviations.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/unit/handeye/one_step_degenerate.hpp"

namespace {

using namespace handeye;
using synthetic::Degenerate;
using synthetic::Verdict;

constexpr double kHonest = 3.5;

/// Of one estimator over seeds.
struct Count {
  int accepted{0};
  int wrong{0};
  int as_named{0};            ///< refused as the motion is called at its worst
  double worst_in_sigmas{0};  ///< of the accepted

  void add(const Verdict& verdict, const Degenerate& motion) {
    if (!verdict.accepted()) {
      as_named += verdict.judgement.problem == motion.problem ? 1 : 0;
      return;
    }
    const double worst = std::max(verdict.rotation_in_sigmas, verdict.translation_in_sigmas);
    ++accepted;
    wrong += worst > kHonest ? 1 : 0;
    worst_in_sigmas = std::max(worst_in_sigmas, worst);
  }
};

std::string describe(const Count& count) {
  return fmt::format("{:>4} accepted, worst {:3.1f} sigma, {:>2} wrong; {:>4} refused by name",
                     count.accepted, count.worst_in_sigmas, count.wrong, count.as_named);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const int seeds = arguments.empty() ? 20 : std::stoi(arguments[0]);
  int wrong = 0;
  for (const Degenerate& motion : synthetic::degenerate_motions()) {
    if (arguments.size() > 1 && arguments[1] != motion.name) continue;
    for (const double amplitude : {0.0, 0.003, 0.01, 0.02, 0.04, 0.08, 0.15, 0.3, 1.0}) {
      Count one_step, likelihood;
      for (int seed = 0; seed < seeds; ++seed) {
        const auto found = synthetic::verdicts(motion, amplitude, static_cast<std::uint32_t>(seed));
        one_step.add(found.one_step, motion);
        likelihood.add(found.likelihood, motion);
      }
      wrong += one_step.wrong + likelihood.wrong;
      fmt::print("{:<20} {:5.3f}  one_step {}  likelihood {}\n", motion.name, amplitude,
                 describe(one_step), describe(likelihood));
      std::fflush(stdout);
    }
  }
  return wrong > 0 ? 1 : 0;
}
