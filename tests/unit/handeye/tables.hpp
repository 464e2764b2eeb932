// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "daemon/handeye/types.hpp"

/// Going through both tables of methods.
namespace handeye::tables {

inline constexpr std::array<ScaleMode, 2> kModes{ScaleMode::kKnown, ScaleMode::kUnknown};

/// Those that solve from movements alone: all but the last.
inline std::span<const Method> movement_methods(ScaleMode mode) {
  const std::span<const Method> all = methods(mode);
  return all.first(all.size() - 1);
}

inline std::string label(const Method& method, ScaleMode mode) {
  return std::string(method.name) + (mode == ScaleMode::kKnown ? ", known" : ", unknown");
}

inline double scale_in(ScaleMode mode, double units_per_mm) {
  return mode == ScaleMode::kKnown ? 1.0 : units_per_mm;
}

/// Rotation to a tenth of the tolerance [rad], translation and scale relative to it.
inline void expect_near(const HandEyeSolution& found, const HandEyeSolution& wanted,
                        double tolerance, const std::string& what) {
  EXPECT_LT(rotation_angle_rad(found.hand_from_eye.linear(), wanted.hand_from_eye.linear()),
            0.1 * tolerance)
      << what;
  EXPECT_LT((found.hand_from_eye.translation() - wanted.hand_from_eye.translation()).norm(),
            tolerance * wanted.hand_from_eye.translation().norm())
      << what;
  EXPECT_NEAR(found.scale_units_per_mm / wanted.scale_units_per_mm, 1.0, tolerance) << what;
}

}  // namespace handeye::tables
