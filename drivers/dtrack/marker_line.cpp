// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/blocks.hpp"
#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/target_list.hpp"

namespace handeye::dtrack {
namespace {

/// `[id qu][x y z]`
Target read_marker(Scanner& line, Marker& marker) {
  if (!line.open_block() || !line.read_id(marker.id, kMaxMarkerId) || !line.read(marker.quality) ||
      !line.close_block() || !read_position(line, marker.position_mm)) {
    return Target::kFailed;
  }
  return marker.quality < 0 ? Target::kLeftOut : Target::kTaken;
}

}  // namespace

bool read_3d(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  return line.read_count(count) &&
         read_targets(line, count, context.frame.markers, context, read_marker);
}

}  // namespace handeye::dtrack
