// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "drivers/dtrack/lines.hpp"

namespace handeye::dtrack {
namespace {

void drop_covariances_without_body(LineContext& context) {
  const auto dropped = std::erase_if(context.frame.covariances, [&](const auto& covariance) {
    return context.frame.find_body(covariance.id) == nullptr;
  });
  context.counters[WarningKind::kCovarianceWithoutBody] += dropped;
}

/// The optical pose of 6d stands; a body that only 6di has, or only 6di still follows, is added.
void merge_hybrid_bodies(LineContext& context) {
  std::vector<Body>& bodies = context.frame.bodies;
  const auto optical = bodies.size();
  for (const Body& hybrid : context.memory.hybrid_bodies) {
    const auto end = bodies.begin() + static_cast<std::ptrdiff_t>(optical);
    const auto body = std::ranges::find(bodies.begin(), end, hybrid.id, &Body::id);
    if (body == end) {
      bodies.push_back(hybrid);
    } else if (!body->tracked) {
      *body = hybrid;
    } else {
      body->inertial_state = hybrid.inertial_state;
      body->inertial_drift_rad = hybrid.inertial_drift_rad;
    }
  }
}

void take_devices_off_calibrated_bodies(LineContext& context) {
  std::optional<std::int32_t>& calibrated = context.frame.calibrated_bodies;
  if (!calibrated) return;
  *calibrated -= context.old_flysticks + context.old_tools;
  if (*calibrated >= 0) return;
  *calibrated = 0;
  ++context.counters[WarningKind::kCalibratedBelowZero];
}

}  // namespace

void settle_lines(LineContext& context) {
  drop_covariances_without_body(context);
  merge_hybrid_bodies(context);
  take_devices_off_calibrated_bodies(context);
}

}  // namespace handeye::dtrack
