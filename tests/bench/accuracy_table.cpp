// SPDX-License-Identifier: BSD-3-Clause
// How accurate a calibration is, by every method: for seeds 1 to N a simulated sequence is recorded
// (25 Hz, 640x480, free-hand motion, tracker noise 0.15 mm and 0.06 deg per axis), replayed with
// the lens given and with the lens to be found, and compared with its truth. accuracy_table [SEEDS
// [SECONDS [FIRST_SEED]]] (default 10, 20, 1). Marks answers that are worse than the best of the
// seed's five methods by more than their own sigma, and says how many chance alone makes of the
// best possible answers. Beside them, what the tracker's noise makes of the answer to perfect
// pictures, with the same mark by that answer's own, smaller sigma. Ends with 1 where an accepted
// answer is beyond 3.5 of its own sigmas, where the answers' rms is not below that of every one of
// the five, or where an answer is marked.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "daemon/session/replay.hpp"
#include "drivers/simulator/record.hpp"
#include "tests/bench/accuracy_chance.hpp"
#include "tests/bench/perfect_camera.hpp"

namespace {

using namespace handeye;
namespace fs = std::filesystem;

constexpr double kHonest = 3.5;

constexpr std::array<std::string_view, 5> kSeedMethods{"dq_scale_separate", "horaud_scale_separate",
                                                       "nonlinear_quaternion",
                                                       "nonlinear_dual_quaternion", "andreff"};

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
  Error error() const { return {std::sqrt(rotation_ / count_), std::sqrt(translation_ / count_)}; }
  std::string text() const {
    return fmt::format("{:>8.4f} deg {:>8.4f} mm  over {}", error().rotation_deg,
                       error().translation_mm, count_);
  }

 private:
  int count_{0};
  double rotation_{0}, translation_{0};
};

/// The table of one way to treat the lens.
class Table {
 public:
  explicit Table(std::string title) : title_(std::move(title)) {}

  /// `perfect`: what perfect pictures would have made of it.
  void add(std::uint64_t seed, const CalibrationResult& result, const simulator::World& world,
           const std::optional<MaximumLikelihoodResult>& perfect);
  void print_end() const;
  bool holds() const;

 private:
  std::string add_methods(const CalibrationResult& result, const Pose& truth);
  std::string add_perfect(const std::optional<MaximumLikelihoodResult>& perfect, const Pose& truth);
  bool is_below_the_five() const;

  std::string title_;
  std::map<std::string, RootMeanSquare> methods_;
  RootMeanSquare answers_, perfect_;
  std::vector<Pose> five_;       ///< answers of the seed's methods to the sequence last added
  bool answer_is_worse_{false};  ///< than the best of them
  double nees_{0}, offset_{0}, offset_square_{0}, offset_in_sigmas_square_{0}, focal_square_{0};
  int estimates_{0}, accepted_{0}, dishonest_{0}, worse_{0}, worse_in_vain_{0};
  std::vector<double> chances_;  ///< of being worse, one a sequence
};

/// The methods' errors for the line; a mark where the best of the five beats the answer clearly.
std::string Table::add_methods(const CalibrationResult& result, const Pose& truth) {
  std::string text;
  ComparedAnswer answer{.hand_from_eye = result.solution.hand_from_eye,
                        .covariance = result.covariance,
                        .sigma_rotation_deg = result.sigma_rotation_deg,
                        .sigma_translation_mm = result.sigma_translation_mm};
  for (const MethodResult& method : result.methods) {
    if (!method.solution) continue;
    const Error error = error_of(method.solution->hand_from_eye, truth);
    methods_[method.name].add(error);
    text += fmt::format("\n      {:<27}{:>8.4f} deg {:>8.4f} mm", method.name, error.rotation_deg,
                        error.translation_mm);
    if (std::ranges::find(kSeedMethods, method.name) == kSeedMethods.end()) continue;
    answer.others.push_back(method.solution->hand_from_eye);
  }
  chances_.push_back(chance_of_being_worse(answer));
  five_ = answer.others;
  answer_is_worse_ = is_worse_than_the_best(answer, truth);
  if (answer_is_worse_) {
    ++worse_;
    text = "   WORSE THAN THE BEST OF FIVE" + text;
  }
  return text;
}

/// A line of its own; a mark where the best of the five beats even that clearly.
std::string Table::add_perfect(const std::optional<MaximumLikelihoodResult>& perfect,
                               const Pose& truth) {
  if (!perfect) return "";
  const ComparedAnswer answer{.hand_from_eye = perfect->solution.hand_from_eye,
                              .covariance = perfect->covariance,
                              .sigma_rotation_deg = perfect->sigma_rotation_deg(),
                              .sigma_translation_mm = perfect->sigma_translation_mm(),
                              .others = five_};
  const bool is_worse = is_worse_than_the_best(answer, truth);
  if (is_worse && answer_is_worse_) ++worse_in_vain_;
  const Error error = error_of(answer.hand_from_eye, truth);
  perfect_.add(error);
  return fmt::format("\n      {:<27}{:>8.4f} deg {:>8.4f} mm{}", "(perfect pictures)",
                     error.rotation_deg, error.translation_mm,
                     is_worse ? "   WORSE THAN THE BEST OF FIVE" : "");
}

void Table::add(std::uint64_t seed, const CalibrationResult& result, const simulator::World& world,
                const std::optional<MaximumLikelihoodResult>& perfect) {
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
  offset_ += offset_error_ms;
  offset_square_ += offset_error_ms * offset_error_ms;
  const double offset_sigma_ms = 1e3 * result.time_offset_sigma_s.value_or(0);
  offset_in_sigmas_square_ += std::pow(offset_error_ms / offset_sigma_ms, 2);
  focal_square_ += focal_percent * focal_percent;
  line += fmt::format(
      " {:.4f} deg (sigma {:.4f}) {:.4f} mm (sigma {:.4f}) nees {:.1f} offset {:+.3f} ms (sigma "
      "{:.3f}) f {:+.3f} % {:.1f} s",
      error.rotation_deg, result.sigma_rotation_deg, error.translation_mm,
      result.sigma_translation_mm, squares, offset_error_ms, offset_sigma_ms, focal_percent,
      result.timings_ms.total / 1000);
  if (accepted && (error.rotation_deg > kHonest * result.sigma_rotation_deg ||
                   error.translation_mm > kHonest * result.sigma_translation_mm)) {
    ++dishonest_;
    line += "   BEYOND 3.5 SIGMA";
  }
  line += add_methods(result, truth);
  fmt::print("{}{}\n", line, add_perfect(perfect, truth));
  std::fflush(stdout);
}

bool Table::is_below_the_five() const {
  return std::ranges::all_of(kSeedMethods, [&](std::string_view name) {
    const auto found = methods_.find(std::string(name));
    if (found == methods_.end()) return true;
    const Error theirs = found->second.error();
    return answers_.error().rotation_deg < theirs.rotation_deg &&
           answers_.error().translation_mm < theirs.translation_mm;
  });
}

bool Table::holds() const {
  return estimates_ > 0 && dishonest_ == 0 && worse_ == 0 && is_below_the_five();
}

void Table::print_end() const {
  fmt::print("\n{}: {} accepted, {} of them beyond 3.5 sigma; the answers: {}\n", title_, accepted_,
             dishonest_, answers_.text());
  for (const auto& [name, square] : methods_) fmt::print("  {:<27}{}\n", name, square.text());
  if (estimates_ == 0) return;
  fmt::print("  {:<27}{}\n", "(perfect pictures)", perfect_.text());
  const double n = estimates_;
  fmt::print("  mean nees {:.2f}, focal length rms {:.3f} %\n", nees_ / n,
             std::sqrt(focal_square_ / n));
  fmt::print("  offset: mean {:+.3f} ms, rms {:.3f} ms, {:.2f} of its sigma\n", offset_ / n,
             std::sqrt(offset_square_ / n), std::sqrt(offset_in_sigmas_square_ / n));
  fmt::print(
      "  worse than the best of five by more than a sigma: {}; of the best possible answers "
      "{:.1f}, "
      "{} or more in {:.0f} % of such tables; so are perfect pictures' answers on {} of them\n",
      worse_, std::accumulate(chances_.begin(), chances_.end(), 0.0), worse_,
      100 * chance_of_so_many(worse_, chances_), worse_in_vain_);
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
    simulator::SimulatorOptions options{.seed = seed};
    if (arguments.size() > 3) options.lens = {std::stod(arguments[3]), 0.0};
    const simulator::World world(options, 1'000'000'000'000);
    simulator::record(world, duration_s, recording);
    const auto perfect = answer_of_perfect_camera(world, recording);
    given.add(seed, replayed(recording, IntrinsicsMode::kFixed), world, perfect);
    estimated.add(seed, replayed(recording, IntrinsicsMode::kEstimate), world, perfect);
    fs::remove_all(recording);
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  given.print_end();
  estimated.print_end();
  return given.holds() && estimated.holds() ? EXIT_SUCCESS : EXIT_FAILURE;
}
