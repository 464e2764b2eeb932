// SPDX-License-Identifier: BSD-3-Clause
// How accurate a calibration is, by every method: for seeds 1 to N a simulated sequence is recorded
// (25 Hz, 640x480, free-hand motion, tracker noise 0.15 mm and 0.06 deg per axis), replayed with
// the lens given and with the lens to be found, and compared with its truth. accuracy_table [SEEDS
// [SECONDS [FIRST_SEED]]] (default 10, 20, 1); ends with 1 where an accepted answer is beyond 3.5
// of its own sigmas, or worse than the best of the seed's five methods by more than its own sigma.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "daemon/session/replay.hpp"
#include "drivers/simulator/record.hpp"

namespace {

using namespace handeye;
namespace fs = std::filesystem;

constexpr double kHonest = 3.5;

constexpr std::array<std::string_view, 5> kSeedMethods{"dq_scale_separate", "horaud_scale_separate",
                                                       "nonlinear_quaternion",
                                                       "nonlinear_dual_quaternion", "andreff"};

struct Error {
  double rotation_deg{0};
  double translation_mm{0};
};

Error error_of(const Pose& found, const Pose& truth) {
  return {deg_from_rad(rotation_angle_rad(found.linear(), truth.linear())),
          (found.translation() - truth.translation()).norm()};
}

/// e' C^-1 e of the answer's six degrees of freedom: 6 in the mean where the covariance is honest.
double nees(const CalibrationResult& result, const Pose& truth) {
  const Pose& found = result.solution.hand_from_eye;
  Eigen::Matrix<double, 6, 1> error;
  error << log_so3(truth.linear() * found.linear().transpose()),
      truth.translation() - found.translation();
  return error.dot(result.covariance.ldlt().solve(error));
}

class RootMeanSquare {
 public:
  void add(const Error& error) {
    ++count_;
    rotation_ += error.rotation_deg * error.rotation_deg;
    translation_ += error.translation_mm * error.translation_mm;
  }
  std::string text() const {
    return fmt::format("{:>8.4f} deg {:>8.4f} mm  over {}", std::sqrt(rotation_ / count_),
                       std::sqrt(translation_ / count_), count_);
  }

 private:
  int count_{0};
  double rotation_{0}, translation_{0};
};

/// The table of one way to treat the lens.
class Table {
 public:
  explicit Table(std::string title) : title_(std::move(title)) {}

  void add(std::uint64_t seed, const CalibrationResult& result, const simulator::World& world);
  void print_end() const;
  int flagged() const { return flagged_; }

 private:
  std::string add_methods(const CalibrationResult& result, const Pose& truth, const Error& answer);

  std::string title_;
  std::map<std::string, RootMeanSquare> methods_;
  RootMeanSquare answers_;
  double nees_{0}, offset_square_{0}, focal_square_{0};
  int estimates_{0}, accepted_{0}, flagged_{0};
};

/// The methods' errors for the line; a flag where the best of the five beats the answer clearly.
std::string Table::add_methods(const CalibrationResult& result, const Pose& truth,
                               const Error& answer) {
  std::string text;
  Error best{1e9, 1e9};
  for (const MethodResult& method : result.methods) {
    if (!method.solution) continue;
    const Error error = error_of(method.solution->hand_from_eye, truth);
    methods_[method.name].add(error);
    text += fmt::format("\n      {:<27}{:>8.4f} deg {:>8.4f} mm", method.name, error.rotation_deg,
                        error.translation_mm);
    if (std::ranges::find(kSeedMethods, method.name) == kSeedMethods.end()) continue;
    best.rotation_deg = std::min(best.rotation_deg, error.rotation_deg);
    best.translation_mm = std::min(best.translation_mm, error.translation_mm);
  }
  if (answer.rotation_deg > best.rotation_deg + result.sigma_rotation_deg ||
      answer.translation_mm > best.translation_mm + result.sigma_translation_mm) {
    ++flagged_;
    text = "   WORSE THAN THE BEST OF FIVE" + text;
  }
  return text;
}

void Table::add(std::uint64_t seed, const CalibrationResult& result,
                const simulator::World& world) {
  const bool accepted = result.verdict == Verdict::kAccepted;
  if (accepted) ++accepted_;
  std::string line = fmt::format("{:<10} seed {:>3} {:<9} {:<16}", title_, seed,
                                 accepted ? "accepted" : "refused", reason_word(result.reason));
  if (!result.has_estimate) {
    fmt::print("{} no estimate\n", line);
    return;
  }
  const Pose& truth = world.hand_from_eye;
  const Error error = error_of(result.solution.hand_from_eye, truth);
  const double offset_error_ms = 1e3 * (result.time_offset_s.value_or(0) - world.time_offset_s());
  const double focal_percent = 100 * (result.camera.fx / world.camera.fx - 1);
  const double squares = nees(result, truth);
  ++estimates_;
  answers_.add(error);
  nees_ += squares;
  offset_square_ += offset_error_ms * offset_error_ms;
  focal_square_ += focal_percent * focal_percent;
  line += fmt::format(
      " {:.4f} deg (sigma {:.4f}) {:.4f} mm (sigma {:.4f}) nees {:.1f} offset {:+.3f} ms (sigma "
      "{:.3f}) f {:+.3f} % {:.1f} s",
      error.rotation_deg, result.sigma_rotation_deg, error.translation_mm,
      result.sigma_translation_mm, squares, offset_error_ms,
      1e3 * result.time_offset_sigma_s.value_or(0), focal_percent, result.timings_ms.total / 1000);
  if (accepted && (error.rotation_deg > kHonest * result.sigma_rotation_deg ||
                   error.translation_mm > kHonest * result.sigma_translation_mm)) {
    ++flagged_;
    line += "   BEYOND 3.5 SIGMA";
  }
  fmt::print("{}{}\n", line, add_methods(result, truth, error));
  std::fflush(stdout);
}

void Table::print_end() const {
  fmt::print("\n{}: {} accepted, {} flagged; the answers: {}\n", title_, accepted_, flagged_,
             answers_.text());
  for (const auto& [name, square] : methods_) fmt::print("  {:<27}{}\n", name, square.text());
  if (estimates_ == 0) return;
  fmt::print("  mean nees {:.2f}, offset rms {:.3f} ms, focal length rms {:.3f} %\n",
             nees_ / estimates_, std::sqrt(offset_square_ / estimates_),
             std::sqrt(focal_square_ / estimates_));
}

CalibrationResult replayed(const fs::path& recording, IntrinsicsMode intrinsics) {
  ReplayOptions options{.recording = recording};
  options.intrinsics = intrinsics;
  return replay(options);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::uint64_t seeds = arguments.empty() ? 10 : std::stoull(arguments[0]);
  const double duration_s = arguments.size() < 2 ? 20.0 : std::stod(arguments[1]);
  const std::uint64_t first = arguments.size() < 3 ? 1 : std::stoull(arguments[2]);
  std::string folder = (fs::temp_directory_path() / "accuracy-XXXXXX").string();
  if (!mkdtemp(folder.data())) {
    fmt::print(stderr, "accuracy_table: no temporary folder {}\n", folder);
    return EXIT_FAILURE;
  }
  const fs::path recording = fs::path(folder) / "recording";
  Table given("given");
  Table estimated("estimated");
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    const simulator::World world({.seed = seed}, 1'000'000'000'000);
    simulator::record(world, duration_s, recording);
    given.add(seed, replayed(recording, IntrinsicsMode::kFixed), world);
    estimated.add(seed, replayed(recording, IntrinsicsMode::kEstimate), world);
    fs::remove_all(recording);
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  given.print_end();
  estimated.print_end();
  return given.flagged() + estimated.flagged() > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}
