// SPDX-License-Identifier: BSD-3-Clause
// Prints Table 1 of Schmidt, Vogt, Niemann 2005 beside the same table for simulated scopes, as
// Markdown, and writes what its figures show. Usage: papers_schmidt RUNS DATA; RUNS has a folder a
// set-up.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/os.h>

#include "protocol/exit_codes.hpp"
#include "tests/bench/papers/table1_runs.hpp"

namespace handeye::papers {
namespace {

/// A row as printed. Times on an Athlon XP 2600+, data selection included.
struct PaperRow {
  std::string_view setup, method;
  std::optional<double> translation_percent, rotation_deg, rotation_percent, time_ms;
};

constexpr std::string_view kPattern = "pattern";

constexpr std::array<PaperRow, 12> kPaper{{
    {"ART1", "dq_scale_separate", 22.3, 0.191, 3.75, 310},
    {"ART1", "horaud_scale_separate", 13.0, 0.179, 3.72, 2090},
    {"ART1", "nonlinear_quaternion", 17.8, 0.191, 3.75, 2350},
    {"ART1", "nonlinear_dual_quaternion", 44.6, 0.191, 3.75, 756},
    {"ART1", "andreff", 13.2, 0.172, 3.60, 309},
    {"ART1", kPattern, 5.39, {}, 1.09, {}},
    {"ART2", "dq_scale_separate", 20.7, 0.290, 7.25, 433},
    {"ART2", "horaud_scale_separate", 18.7, 0.266, 7.00, 1590},
    {"ART2", "nonlinear_quaternion", 18.4, 0.290, 7.25, 1770},
    {"ART2", "nonlinear_dual_quaternion", 20.7, 0.290, 7.25, 482},
    {"ART2", "andreff", 19.7, 0.272, 7.10, 434},
    {"ART2", kPattern, 4.20, {}, 0.725, {}},
}};

/// The set-ups in the order of the table; the last has no counterpart in the paper.
constexpr std::array<std::string_view, 3> kSetups{"ART1", "ART2", "wide"};

/// With the pattern: the linear method that the paper's own group used, and the answer.
constexpr std::array<std::string_view, 2> kPatternMethods{"daniilidis", "maximum_likelihood"};

PaperRow paper_row(std::string_view setup, std::string_view method) {
  for (const PaperRow& row : kPaper) {
    if (row.setup == setup && row.method == method) return row;
  }
  return {setup, method, {}, {}, {}, {}};
}

std::string cell(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string cell(const std::optional<double>& printed) {
  return printed ? fmt::format("{:g}", *printed) : "";
}

void print_row(const std::string& label, const MethodFigures& ours, const PaperRow& paper,
               std::size_t runs) {
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} of {} |\n", label,
             cell(ours.translation_percent, 2), cell(paper.translation_percent),
             cell(ours.translation_norm_percent, 2), cell(ours.rotation_deg, 3),
             cell(paper.rotation_deg), cell(ours.rotation_percent, 2), cell(paper.rotation_percent),
             cell(ours.time_ms, 1), cell(paper.time_ms), cell(ours.error_deg, 3),
             cell(ours.error_mm, 2), ours.solved, runs);
}

void print_setup(const SetupFigures& setup) {
  fmt::print(
      "**{}**: {} images, tracker noise {:g} deg and {:g} mm per axis, turned by up to "
      "{:g} deg and shifted by up to {:g} mm; medians of {} scopes; accepted {} without "
      "pattern, {} with `{}`\n\n",
      setup.name, setup.images, setup.noise_deg, setup.noise_mm, setup.largest_turn_deg,
      setup.largest_shift_mm, setup.runs, setup.accepted, setup.pattern_accepted, setup.board);
  fmt::print("{}\n{}\n",
             "| method | transl. % | paper | norm % | rot. deg | paper | rot. % | paper | ms | "
             "paper | error deg | error mm | solved |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (const MethodFigures& method : setup.without_pattern) {
    print_row(method.name, method, paper_row(setup.name, method.name), setup.runs);
  }
  for (const MethodFigures& method : setup.with_pattern) {
    const auto* const shown = std::ranges::find(kPatternMethods, method.name);
    if (shown == kPatternMethods.end()) continue;
    print_row("pattern, " + method.name, method, paper_row(setup.name, kPattern), setup.runs);
  }
  fmt::print("\n");
}

/// One block a set-up: label, ours and the paper's residuals, the true errors; gnuplot reads nan.
void write_plot_data(const std::vector<SetupFigures>& setups, const std::string& file) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  auto out = fmt::output_file(file);
  const auto write = [&](const std::string& label, const MethodFigures& ours,
                         const PaperRow& paper) {
    out.print("{} {:.5f} {:.5f} {:.5f} {:.5f} {:.5f} {:.5f} {:.5f} {:.5f}\n", label,
              ours.translation_percent, paper.translation_percent.value_or(kNone),
              ours.rotation_deg, paper.rotation_deg.value_or(kNone), ours.rotation_percent,
              paper.rotation_percent.value_or(kNone), ours.error_deg, ours.error_mm);
  };
  for (const SetupFigures& setup : setups) {
    out.print("# {}\n", setup.name);
    for (const MethodFigures& method : setup.without_pattern) {
      write(method.name, method, paper_row(setup.name, method.name));
    }
    write(std::string(kPattern), setup.with_pattern.back(), paper_row(setup.name, kPattern));
    out.print("\n\n");
  }
}

}  // namespace
}  // namespace handeye::papers

int main(int argc, char** argv) {
  using namespace handeye;
  using namespace handeye::papers;
  if (argc != 3) {
    fmt::print(stderr, "usage: papers_schmidt RUNS DATA\n");
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    std::vector<SetupFigures> setups;
    for (const std::string_view name : kSetups) {
      setups.push_back(read_setup(std::filesystem::path(argv[1]) / name));
      print_setup(setups.back());
    }
    write_plot_data(setups, argv[2]);
    return static_cast<int>(ExitCode::kOk);
  } catch (const std::exception& error) {
    fmt::print(stderr, "table1: {}\n", error.what());
    return static_cast<int>(ExitCode::kInput);
  }
}
