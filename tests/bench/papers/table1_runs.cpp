// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/papers/table1_runs.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/geometry/pose.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::papers {
namespace {

using Json = nlohmann::ordered_json;

Json read_json(const std::filesystem::path& file) {
  std::ifstream stream(file);
  Json json = Json::parse(stream, nullptr, false);
  if (json.is_discarded()) {
    throw InputError(
        fmt::format("{}: no JSON document; run the reproduction again", file.string()));
  }
  return json;
}

Pose pose_of(const Json& json) {
  const auto q = json.at("q_wxyz").get<std::array<double, 4>>();
  const auto t = json.at("t_mm").get<std::array<double, 3>>();
  return make_pose(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), {t[0], t[1], t[2]});
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// A result and the truth of its run.
struct Run {
  Json result;
  Pose truth;
};

MethodFigures figures_of(const std::string& method, const std::vector<Run>& runs) {
  std::vector<double> translation, norm, degrees, percent, time, error_deg, error_mm;
  for (const Run& run : runs) {
    for (const Json& row : run.result.at("methods")) {
      if (row.at("name") != method || row.at("hand_from_eye").is_null()) continue;
      const Json& residuals = row.at("residuals");
      translation.push_back(residuals.at("translation_percent"));
      norm.push_back(residuals.at("translation_norm_percent"));
      degrees.push_back(residuals.at("rotation_deg"));
      percent.push_back(residuals.at("rotation_percent"));
      time.push_back(row.at("time_ms"));
      const Pose found = pose_of(row.at("hand_from_eye"));
      error_deg.push_back(
          deg_from_rad(log_so3(run.truth.linear().transpose() * found.linear()).norm()));
      error_mm.push_back((found.translation() - run.truth.translation()).norm());
    }
  }
  return {.name = method,
          .solved = translation.size(),
          .translation_percent = median(translation),
          .translation_norm_percent = median(norm),
          .rotation_deg = median(degrees),
          .rotation_percent = median(percent),
          .time_ms = median(time),
          .error_deg = median(error_deg),
          .error_mm = median(error_mm)};
}

/// Every method that any run lists, in the order of the first.
std::vector<MethodFigures> all_figures(const std::vector<Run>& runs) {
  std::vector<MethodFigures> figures;
  for (const Json& row : runs.front().result.at("methods")) {
    figures.push_back(figures_of(row.at("name"), runs));
  }
  return figures;
}

std::size_t accepted(const std::vector<Run>& runs) {
  return static_cast<std::size_t>(std::ranges::count_if(
      runs, [](const Run& run) { return run.result.at("verdict") == "accepted"; }));
}

void describe(const Json& truth, SetupFigures& setup) {
  setup.noise_deg = truth.at("tracker_noise").at("deg");
  setup.noise_mm = truth.at("tracker_noise").at("mm");
  setup.largest_turn_deg = truth.at("amplitude").at("deg");
  setup.largest_shift_mm = truth.at("amplitude").at("mm");
  setup.board = truth.at("board");
}

}  // namespace

SetupFigures read_setup(const std::filesystem::path& folder) {
  SetupFigures setup{.name = folder.filename().string()};
  std::vector<Run> without;
  std::vector<Run> with;
  const auto file = [&](const char* kind) {
    return folder / fmt::format("{}.{}.json", setup.runs + 1, kind);
  };
  for (; std::filesystem::exists(file("truth")); ++setup.runs) {
    const Json truth = read_json(file("truth"));
    describe(truth, setup);
    const Pose hand_from_eye = pose_of(truth.at("hand_from_eye"));
    without.push_back({read_json(file("sfm")), hand_from_eye});
    with.push_back({read_json(file("pattern")), hand_from_eye});
  }
  if (setup.runs == 0) {
    throw InputError(fmt::format("{}: no runs; start the reproduction", folder.string()));
  }
  setup.images = without.front().result.at("frames").at("received");
  setup.accepted = accepted(without);
  setup.pattern_accepted = accepted(with);
  setup.without_pattern = all_figures(without);
  setup.with_pattern = all_figures(with);
  return setup;
}

}  // namespace handeye::papers
