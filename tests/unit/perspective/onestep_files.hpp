// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/handeye/perspective/observations.hpp"

namespace handeye::test {

/// OBSERVATIONS.json of `handeye onestep`.
inline nlohmann::json observations_json(const Observations& observations) {
  nlohmann::json json{{"width", observations.width},
                      {"height", observations.height},
                      {"pixel_mm", {observations.pixel_mm.x(), observations.pixel_mm.y()}},
                      {"positions", nlohmann::json::array()}};
  for (const ObservedPosition& position : observations.positions) {
    const Eigen::Quaterniond q(position.hand1_from_hand.linear());
    const Eigen::Vector3d t = position.hand1_from_hand.translation();
    nlohmann::json points = nlohmann::json::array();
    for (const ObjectPoint& point : position.points) {
      const Eigen::Vector3d& x = point.object_mm;
      points.push_back({x.x(), x.y(), x.z(), point.pixel.x(), point.pixel.y()});
    }
    json["positions"].push_back(
        {{"hand1_from_hand",
          {{"q_wxyz", {q.w(), q.x(), q.y(), q.z()}}, {"t_mm", {t.x(), t.y(), t.z()}}}},
         {"points", points}});
  }
  return json;
}

}  // namespace handeye::test
