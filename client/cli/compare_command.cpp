// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

#include "client/cli/commands.hpp"
#include "client/cli/comparison.hpp"
#include "client/cli/options.hpp"
#include "client/cli/status_text.hpp"

namespace handeye::cli {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct CompareOptions {
  OutputOptions output;
  std::filesystem::path result;
  std::filesystem::path truth;
  double max_rotation_deg{kUnlimited};
  double max_translation_mm{kUnlimited};
  double max_time_offset_ms{kUnlimited};
};

std::string error_row(std::string_view name, double error, double limit, std::string_view unit,
                      const Palette& palette) {
  const std::string value = fmt::format("{:>9.4f} {:<4}", error, unit);
  const bool within = error <= limit;
  std::string text = fmt::format("  {:<13}{}", name, within ? value : palette.red(value));
  if (std::isfinite(limit)) {
    text += fmt::format("  {} {:g} {}", within ? "within" : "beyond", limit, unit);
  }
  return text + "\n";
}

std::string comparison_text(const KnownCalibration& estimate, const CalibrationError& error,
                            const CompareOptions& options) {
  const Palette palette = options.output.palette();
  std::string text = "error against the truth";
  if (!estimate.verdict.empty()) text += " of a result that was " + printable(estimate.verdict);
  text += "\n";
  text += error_row("rotation", error.rotation_deg, options.max_rotation_deg, "deg", palette);
  text += error_row("translation", error.translation_mm, options.max_translation_mm, "mm", palette);
  if (error.time_offset_ms) {
    text += error_row("time offset", std::abs(*error.time_offset_ms), options.max_time_offset_ms,
                      "ms", palette);
  }
  return text;
}

ExitCode run_compare(const CompareOptions& options) {
  const KnownCalibration estimate = read_calibration(options.result);
  const KnownCalibration truth = read_calibration(options.truth);
  const CalibrationError error = calibration_error(estimate, truth);
  if (std::isfinite(options.max_time_offset_ms) && !error.time_offset_ms) {
    throw InputError("--max-time-offset needs time_offset_s in both files");
  }
  const bool within = error.rotation_deg <= options.max_rotation_deg &&
                      error.translation_mm <= options.max_translation_mm &&
                      std::abs(error.time_offset_ms.value_or(0)) <= options.max_time_offset_ms;
  if (options.output.json) {
    nlohmann::ordered_json json{{"rotation_deg", error.rotation_deg},
                                {"translation_mm", error.translation_mm},
                                {"time_offset_ms", nullptr},
                                {"within_limits", within}};
    if (error.time_offset_ms) json["time_offset_ms"] = *error.time_offset_ms;
    print_line(dump_json(json));
  } else {
    std::fputs(comparison_text(estimate, error, options).c_str(), stdout);
  }
  return within ? ExitCode::kOk : ExitCode::kRefused;
}

}  // namespace

void add_compare_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "print the error of a result against a known truth");
  command->add_option("result", options->result, "result JSON")->required()->type_name("RESULT");
  command->add_option("truth", options->truth, "truth.json, as the simulator writes it")
      ->required()
      ->type_name("TRUTH");
  const auto limit = [&](const char* name, double& value, const char* unit) {
    command->add_option(name, value, "largest error that is still fine")
        ->check(CLI::PositiveNumber)
        ->type_name(unit);
  };
  limit("--max-rotation", options->max_rotation_deg, "DEG");
  limit("--max-translation", options->max_translation_mm, "MM");
  limit("--max-time-offset", options->max_time_offset_ms, "MS");
  add_output_options(*command, options->output);
  command->footer("Exit code: 0 within the limits given, 3 beyond one, 2 unusable files.");
  command->callback([options, &action] { action = [options] { return run_compare(*options); }; });
}

}  // namespace handeye::cli
