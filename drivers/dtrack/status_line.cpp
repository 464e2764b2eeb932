// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/target_list.hpp"

namespace handeye::dtrack {
namespace {

/// Groups by number. Each tells how many values follow, and later versions may append some.
constexpr std::int32_t kGeneralGroup = 0;
constexpr std::int32_t kMessageGroup = 1;
constexpr std::int32_t kCameraGroup = 2;
constexpr std::int32_t kGeneralValues = 3;
constexpr std::int32_t kMessageValues = 5;
constexpr std::int32_t kCameraValues = 3;  ///< besides the camera's number

bool read_status(Scanner& line, std::int32_t& value) {
  return line.read(value, 0, std::numeric_limits<std::int32_t>::max());
}

/// The rest of a group's head: at least `needed` values must have been announced.
bool read_value_count(Scanner& line, std::int32_t needed) {
  std::int32_t values = 0;
  if (!line.read_count(values)) return false;
  return values >= needed ? line.close_block() : line.fail(ErrorKind::kBadCount);
}

/// `3][cameras bodies markers]`
bool read_general(Scanner& line, SystemStatus& status) {
  return read_value_count(line, kGeneralValues) && line.open_block() &&
         read_status(line, status.cameras) && read_status(line, status.bodies) &&
         read_status(line, status.markers) && line.close_block();
}

/// `5][camErr camWarn otherErr otherWarn info]`
bool read_messages(Scanner& line, SystemStatus& status) {
  return read_value_count(line, kMessageValues) && line.open_block() &&
         read_status(line, status.camera_errors) && read_status(line, status.camera_warnings) &&
         read_status(line, status.other_errors) && read_status(line, status.other_warnings) &&
         read_status(line, status.infos) && line.close_block();
}

/// `[cam reflections used maxIntensity]`
Target read_camera(Scanner& line, CameraStatus& camera) {
  return taken_if(line.open_block() && line.read_id(camera.id) &&
                  read_status(line, camera.reflections) &&
                  read_status(line, camera.reflections_used) &&
                  read_status(line, camera.max_intensity) && line.close_block());
}

/// `ncam 3]`, then the cameras.
bool read_cameras(Scanner& line, SystemStatus& status, LineContext& context) {
  std::int32_t count = 0;
  if (!line.read_count(count, kMaxCameras) || !read_value_count(line, kCameraValues)) return false;
  if (count > 0 && status.camera_status.empty()) {
    status.camera_status = context.memory.camera_status.take();
  }
  ListUpdate<CameraStatus> update(status.camera_status, context);
  for (std::int32_t i = 0; i < count; ++i) {
    const Target camera = read_camera(line, update.append());
    if (camera == Target::kFailed) return false;
    update.settle_last(camera);
  }
  update.commit();
  return true;
}

/// All groups, to the end of the line. Groups come in order of their number; the layout of those
/// above the known ones is not known, so everything from there on is passed over.
bool read_groups(Scanner& line, SystemStatus& status, LineContext& context) {
  std::int32_t groups = 0;
  if (!line.read_count(groups)) return false;
  for (std::int32_t i = 0; i < groups; ++i) {
    std::int32_t group = 0;
    if (!line.open_block() || !line.read_id(group)) return false;
    if (group > kCameraGroup) return true;
    const bool good = group == kGeneralGroup   ? read_general(line, status)
                      : group == kMessageGroup ? read_messages(line, status)
                                               : read_cameras(line, status, context);
    if (!good) return false;
  }
  if (!line.at_block()) return line.finish();
  ++context.counters[WarningKind::kSurplusTargets];
  return true;
}

}  // namespace

bool read_st(Scanner& line, LineContext& context) {
  SystemStatus status;
  const bool good = read_groups(line, status, context);
  if (good) {
    if (context.frame.system_status) release(*context.frame.system_status, context.memory);
    context.frame.system_status = std::move(status);
  } else {
    release(status, context.memory);
  }
  return good;
}

}  // namespace handeye::dtrack
