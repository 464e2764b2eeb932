// SPDX-License-Identifier: BSD-3-Clause
// one_step on synthetic tracks, against the Cramer-Rao bound and beside its start:
// one_step_table [SEEDS [CASE...]]; 100 seeds and every case where nothing is said.
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "tests/bench/one_step/cases.hpp"
#include "tests/unit/handeye/one_step_trials.hpp"

namespace {

using namespace handeye;
using synthetic::row;

void print_row(std::string_view name, std::string_view estimator, const std::string& figures) {
  fmt::print("{:<34} {}\n", fmt::format("{}, {}", name, estimator), figures);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const int seeds = arguments.empty() ? 100 : std::stoi(arguments[0]);
  const auto band = synthetic::nees_band(seeds);
  fmt::print("{} seeds; mean NEES of an honest covariance {:.2f} to {:.2f} (99.9 %)\n\n", seeds,
             band.low, band.high);
  fmt::print("{}", synthetic::header());
  for (const bench::OneStepCase& each : bench::one_step_cases()) {
    bool wanted = arguments.size() < 2;
    for (std::size_t i = 1; i < arguments.size(); ++i) wanted |= arguments[i] == each.name;
    if (!wanted) continue;
    const int runs = std::min(seeds, each.most_seeds);
    const auto found = synthetic::study(each.options, each.source, runs, each.bound_every);
    print_row(each.name, "one_step", row(found.one_step));
    print_row(each.name, "likelihood", row(found.likelihood));
  }
  return 0;
}
