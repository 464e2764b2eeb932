// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/geometry/pose.hpp"
#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye::test {

/// Parses a text that must be exactly one JSON document; throws (and so fails the test) if not.
inline nlohmann::json parse_json(const std::string& text) {
  return nlohmann::json::parse(text);
}

inline nlohmann::json read_json(const std::filesystem::path& file) {
  return parse_json(read_bytes(file));
}

/// {"q_wxyz": [...], "t_mm": [...]}.
inline Pose pose_of(const nlohmann::json& json) {
  const auto q = json.at("q_wxyz").get<std::array<double, 4>>();
  const auto t = json.at("t_mm").get<std::array<double, 3>>();
  return make_pose({q[0], q[1], q[2], q[3]}, {t[0], t[1], t[2]});
}

/// Whether two poses of the same two frames agree.
inline testing::AssertionResult near(const Pose& actual, const Pose& expected, double rotation_deg,
                                     double translation_mm) {
  const double turned = deg_from_rad(rotation_angle_rad(actual.linear(), expected.linear()));
  const double moved = (actual.translation() - expected.translation()).norm();
  const std::string text =
      "they differ by " + std::to_string(turned) + " deg and " + std::to_string(moved) + " mm";
  if (turned <= rotation_deg && moved <= translation_mm) {
    return testing::AssertionSuccess() << text;
  }
  return testing::AssertionFailure() << text;
}

}  // namespace handeye::test
