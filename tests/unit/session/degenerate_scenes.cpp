// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/degenerate_scenes.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "daemon/session/replay.hpp"
#include "drivers/simulator/record.hpp"

namespace handeye::degenerate {
namespace {

using simulator::MotionKind;
using simulator::SceneKind;
using simulator::SimulatorOptions;

constexpr double kHonest = 3.5;  // error in its own standard deviations

void cover_lens(SimulatorOptions& options) {
  options.disturbances.dark_s = 1.5;
}

const std::array<Scene, 18> kScenes{{
    {"plain", [](SimulatorOptions&) {}, {}},
    {"plane", [](SimulatorOptions& o) { o.scene = SceneKind::kPlane; }, {}},
    {"bare", [](SimulatorOptions& o) { o.scene = SceneKind::kBare; }, {}},
    {"instrument", [](SimulatorOptions& o) { o.disturbances.instrument = true; }, {}},
    {"covered_lens", cover_lens, {}},
    {"frozen",
     [](SimulatorOptions& o) { simulator::add_disturbance("frozen", o.disturbances); },
     {}},
    {"interlaced", [](SimulatorOptions& o) { o.disturbances.interlaced = true; }, {}},
    {"rotation",
     [](SimulatorOptions& o) { o.motion = MotionKind::kRotation; },
     {Reason::kNoParallax}},
    {"translation",
     [](SimulatorOptions& o) { o.motion = MotionKind::kTranslation; },
     {Reason::kInsufficientRotation}},
    {"single_axis",
     [](SimulatorOptions& o) { o.motion = MotionKind::kSingleAxis; },
     {Reason::kSingleAxis}},
    {"pivot", [](SimulatorOptions& o) { o.motion = MotionKind::kPivot; }, {Reason::kFixedPoint}},
    {"static", [](SimulatorOptions& o) { o.motion = MotionKind::kStatic; }, {Reason::kNoMotion}},
    {"wobble", [](SimulatorOptions& o) { o.motion = MotionKind::kWobble; }, {Reason::kNoMotion}},
    {"roll_only",
     [](SimulatorOptions& o) { o.motion = MotionKind::kRollOnly; },
     {Reason::kNoParallax}},
    {"pivot_slide", [](SimulatorOptions& o) { o.motion = MotionKind::kPivotSlide; }, {}},
    {"rotation_of_plane",
     [](SimulatorOptions& o) {
       o.motion = MotionKind::kRotation;
       o.scene = SceneKind::kPlane;
     },
     {Reason::kNoParallax}},
    {"pivot_with_covered_lens",
     [](SimulatorOptions& o) {
       o.motion = MotionKind::kPivot;
       cover_lens(o);
     },
     {Reason::kFixedPoint}},
    {"instrument_before_plane",
     [](SimulatorOptions& o) {
       o.disturbances.instrument = true;
       o.scene = SceneKind::kPlane;
     },
     {}},
}};

/// A folder that goes with its owner.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "degenerate-XXXXXX").string();
    if (!mkdtemp(path.data())) throw std::runtime_error("no temporary folder: " + path);
    path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::span<const Scene> scenes() {
  return kScenes;
}

const Scene& scene(std::string_view name) {
  const auto* const found = std::ranges::find(kScenes, name, &Scene::name);
  if (found == kScenes.end()) throw std::out_of_range(std::string(name));
  return *found;
}

double Trial::error_in_sigmas() const {
  return std::max(rotation_error_deg / result.sigma_rotation_deg,
                  translation_error_mm / result.sigma_translation_mm);
}

Trial run(const Scene& scene, std::uint64_t seed, double duration_s) {
  SimulatorOptions options{.seed = seed};
  scene.apply(options);
  const simulator::World world(options, 1'000'000'000'000);
  const TemporaryFolder folder;
  const std::filesystem::path recording = folder.path() / "recording";
  simulator::record(world, duration_s, recording);

  Trial trial{.result = replay({.recording = recording})};
  if (trial.result.has_estimate) {
    const Pose& found = trial.result.solution.hand_from_eye;
    trial.rotation_error_deg =
        deg_from_rad(rotation_angle_rad(found.linear(), world.hand_from_eye.linear()));
    trial.translation_error_mm = (found.translation() - world.hand_from_eye.translation()).norm();
  }
  return trial;
}

bool is_right(const Scene& scene, const Trial& trial) {
  if (trial.accepted()) return scene.reasons.empty() && trial.error_in_sigmas() < kHonest;
  return scene.reasons.empty() ||
         std::ranges::find(scene.reasons, trial.result.reason) != scene.reasons.end();
}

std::string describe(const Trial& trial) {
  const CalibrationResult& result = trial.result;
  if (!result.has_estimate) {
    return fmt::format("refused, {} ({})", reason_word(result.reason), result.missing);
  }
  return fmt::format("{} {} {:.3f} deg (sigma {:.3f}), {:.2f} mm (sigma {:.2f}), {} of {} frames",
                     trial.accepted() ? "accepted"
                                      : fmt::format("refused, {} ({}),", reason_word(result.reason),
                                                    result.missing),
                     result.method, trial.rotation_error_deg, result.sigma_rotation_deg,
                     trial.translation_error_mm, result.sigma_translation_mm, result.frames.used,
                     result.frames.received);
}

}  // namespace handeye::degenerate
