// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/disturbance.hpp"

#include <algorithm>
#include <array>

namespace handeye::simulator {
namespace {

struct Kind {
  void (*add)(Disturbances&);
  bool (*is_on)(const Disturbances&);
};

constexpr std::array<std::string_view, 9> kNames{"flicker",    "highlights", "round",
                                                 "blur",       "missing",    "instrument",
                                                 "interlaced", "frozen",     "dark"};

/// In the order of the names.
constexpr std::array<Kind, kNames.size()> kKinds{{
    {[](Disturbances& d) { d.flicker = 0.35; },
     [](const Disturbances& d) { return d.flicker > 0; }},
    {[](Disturbances& d) { d.highlights = true; },
     [](const Disturbances& d) { return d.highlights; }},
    {[](Disturbances& d) { d.round_view = true; },
     [](const Disturbances& d) { return d.round_view; }},
    {[](Disturbances& d) {
       d.defocus_px = 1.5;
       d.exposure_s = 0.015;
     },
     [](const Disturbances& d) { return d.defocus_px > 0 || d.exposure_s > 0; }},
    {[](Disturbances& d) { d.missing_share = 0.08; },
     [](const Disturbances& d) { return d.missing_share > 0; }},
    {[](Disturbances& d) { d.instrument = true; },
     [](const Disturbances& d) { return d.instrument; }},
    {[](Disturbances& d) { d.interlaced = true; },
     [](const Disturbances& d) { return d.interlaced; }},
    {[](Disturbances& d) { d.frozen_s = 1.0; },
     [](const Disturbances& d) { return d.frozen_s > 0; }},
    {[](Disturbances& d) { d.dark_s = 1.0; }, [](const Disturbances& d) { return d.dark_s > 0; }},
}};

}  // namespace

bool add_disturbance(std::string_view name, Disturbances& disturbances) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return false;
  kKinds[static_cast<std::size_t>(found - kNames.begin())].add(disturbances);
  return true;
}

std::span<const std::string_view> disturbance_names() {
  return kNames;
}

std::string describe(const Disturbances& disturbances) {
  std::string names;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (!kKinds[i].is_on(disturbances)) continue;
    if (!names.empty()) names += ',';
    names += kNames[i];
  }
  return names.empty() ? "none" : names;
}

}  // namespace handeye::simulator
