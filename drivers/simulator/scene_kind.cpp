// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/scene_kind.hpp"

#include <array>
#include <utility>

namespace handeye::simulator {
namespace {

constexpr std::array<std::pair<SceneKind, std::string_view>, 3> kNames{{
    {SceneKind::kTissue, "tissue"},
    {SceneKind::kPlane, "plane"},
    {SceneKind::kBare, "bare"},
}};

}  // namespace

std::string_view scene_name(SceneKind kind) {
  for (const auto& [known, name] : kNames) {
    if (known == kind) return name;
  }
  return {};
}

std::optional<SceneKind> scene_from_name(std::string_view name) {
  for (const auto& [kind, known] : kNames) {
    if (known == name) return kind;
  }
  return std::nullopt;
}

}  // namespace handeye::simulator
