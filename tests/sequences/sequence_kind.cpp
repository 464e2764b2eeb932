// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sequences/sequence_kind.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye::sequences {
namespace {

using simulator::MotionKind;
using simulator::SceneKind;
using simulator::SimulatorOptions;

struct Kind {
  std::string_view name;
  void (*apply)(SimulatorOptions&);
};

void disturb(std::string_view name, SimulatorOptions& options) {
  simulator::add_disturbance(name, options.disturbances);
}

constexpr std::array<Kind, 15> kKinds{{
    {"plain", [](SimulatorOptions&) {}},
    {"flicker", [](SimulatorOptions& o) { disturb("flicker", o); }},
    {"highlights", [](SimulatorOptions& o) { disturb("highlights", o); }},
    {"round_mask", [](SimulatorOptions& o) { disturb("round", o); }},
    {"distortion",
     [](SimulatorOptions& o) {
       o.lens = {-0.3, 0.0};
     }},
    {"blur", [](SimulatorOptions& o) { disturb("blur", o); }},
    {"noise", [](SimulatorOptions& o) { o.image_noise_grey = 4.0; }},
    {"missing_frames", [](SimulatorOptions& o) { disturb("missing", o); }},
    {"plane", [](SimulatorOptions& o) { o.scene = SceneKind::kPlane; }},
    {"rotation", [](SimulatorOptions& o) { o.motion = MotionKind::kRotation; }},
    {"bare", [](SimulatorOptions& o) { o.scene = SceneKind::kBare; }},
    {"instrument", [](SimulatorOptions& o) { disturb("instrument", o); }},
    {"interlaced", [](SimulatorOptions& o) { disturb("interlaced", o); }},
    {"frozen", [](SimulatorOptions& o) { disturb("frozen", o); }},
    {"dark", [](SimulatorOptions& o) { disturb("dark", o); }},
}};

constexpr std::size_t kMustHave = 8;

constexpr auto kNames = [] {
  std::array<std::string_view, kKinds.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kKinds[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> must_have_names() {
  return std::span(kNames).first(kMustHave);
}

std::span<const std::string_view> hard_names() {
  return std::span(kNames).subspan(kMustHave);
}

SimulatorOptions simulator_options(std::string_view name, const SequenceOptions& options) {
  const auto* const kind = std::ranges::find(kKinds, name, &Kind::name);
  if (kind == kKinds.end()) {
    throw UsageError(
        fmt::format("sequence '{}': unknown; choose one of {}", name, fmt::join(kNames, ", ")));
  }
  SimulatorOptions chosen;
  chosen.seed = options.seed;
  chosen.width = options.width;
  chosen.height = options.height;
  chosen.camera_rate_hz = options.camera_rate_hz;
  kind->apply(chosen);
  return chosen;
}

}  // namespace handeye::sequences
