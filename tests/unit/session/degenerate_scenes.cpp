// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/degenerate_scenes.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "daemon/session/replay.hpp"
#include "drivers/simulator/record.hpp"

namespace handeye::degenerate {
namespace {

using simulator::MotionKind;
using simulator::SceneKind;
using simulator::SimulatorOptions;

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
  return trial::scene_named<SimulatorOptions>(name, kScenes);
}

Trial run(const Scene& scene, std::uint64_t seed, double duration_s) {
  SimulatorOptions options{.seed = seed};
  scene.apply(options);
  const simulator::World world(options, 1'000'000'000'000);
  const TemporaryFolder folder;
  const std::filesystem::path recording = folder.path() / "recording";
  simulator::record(world, duration_s, recording);
  return trial::against(world.hand_from_eye, replay({.recording = recording}));
}

bool is_right(const Scene& scene, const Trial& trial) {
  if (scene.reasons.empty()) return !trial.accepted() || trial.is_honest();
  return trial.refused_for_any(scene.reasons);
}

}  // namespace handeye::degenerate
