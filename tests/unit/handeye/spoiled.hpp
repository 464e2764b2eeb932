// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <random>
#include <string_view>
#include <vector>

#include "daemon/handeye/types.hpp"

/// Poses with noise, and with gross errors.
namespace handeye::synthetic {

/// Independent Gaussian noise on every pose; the eye's translation in units of the scene.
void add_noise(std::vector<PosePair>& poses, const PoseNoise& noise, double scale_units_per_mm,
               std::mt19937& generator);

/// The first of every `step`: a long motion in few poses.
std::vector<PosePair> every(std::size_t step, const std::vector<PosePair>& poses);

enum class Spoiling {
  kRandomHand,      ///< anywhere
  kEyeTranslation,  ///< by 30 mm an axis
  kEyeRotation,     ///< by 5 deg an axis
  kSwappedMarkers,  ///< the same wrong hand frame every time
  kStuckHand,       ///< the same pose every time
  kHandJump,        ///< 2 m along one axis
};
struct NamedSpoiling {
  Spoiling spoiling;
  std::string_view name;
};
inline constexpr std::array<NamedSpoiling, 6> kSpoilings{{
    {Spoiling::kRandomHand, "random hand"},
    {Spoiling::kEyeTranslation, "eye translation"},
    {Spoiling::kEyeRotation, "eye rotation"},
    {Spoiling::kSwappedMarkers, "swapped markers"},
    {Spoiling::kStuckHand, "stuck hand"},
    {Spoiling::kHandJump, "hand jump"},
}};

/// `count` of 0..n-1, ascending: anywhere, or one stretch.
std::vector<std::size_t> some_of(std::size_t n, std::size_t count, bool one_stretch,
                                 std::mt19937& generator);

std::vector<PosePair> spoiled(std::vector<PosePair> poses, const std::vector<std::size_t>& which,
                              Spoiling spoiling, double scale_units_per_mm,
                              std::mt19937& generator);

std::vector<PosePair> without(const std::vector<PosePair>& poses,
                              const std::vector<std::size_t>& which);

}  // namespace handeye::synthetic
