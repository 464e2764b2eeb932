// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/blocks.hpp"
#include "drivers/dtrack/buttons.hpp"
#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/target_list.hpp"

namespace handeye::dtrack {
namespace {

/// Of the old format's button word. The vendor's own mapping to a joystick: left and down are -1.
constexpr std::int32_t kOldButtons = 4;
constexpr std::uint32_t kOldDown = 0x10;
constexpr std::uint32_t kOldLeft = 0x20;
constexpr std::uint32_t kOldUp = 0x40;
constexpr std::uint32_t kOldRight = 0x80;

double direction(std::uint32_t word, std::uint32_t minus, std::uint32_t plus) {
  return ((word & plus) != 0 ? 1.0 : 0.0) - ((word & minus) != 0 ? 1.0 : 0.0);
}

Target set_pose(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& position_mm,
                Flystick& flystick) {
  flystick.tracked = flystick.quality >= 0;
  if (!flystick.tracked) return Target::kTaken;
  return make_pose_of_printed(matrix, position_mm, flystick.room_from_body) ? Target::kTaken
                                                                            : Target::kBadRotation;
}

/// `[id qu nbt nct][x y z][b0 .. b8][button words, then joystick values]`
Target read_flystick(Scanner& line, Flystick& flystick, LineMemory& memory) {
  std::int32_t buttons = 0;
  std::int32_t joysticks = 0;
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(flystick.id) || !line.read(flystick.quality) ||
      !line.read_count(buttons, kMaxButtons) || !line.read_count(joysticks, kMaxJoysticks) ||
      !line.close_block() || !read_position(line, position_mm) || !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  if (buttons > 0) flystick.buttons = memory.buttons.take();
  if (joysticks > 0) flystick.joysticks = memory.joysticks.take();
  flystick.joysticks.resize(static_cast<std::size_t>(joysticks));
  if (!line.open_block() || !read_buttons(line, buttons, flystick.buttons) ||
      !line.read(std::span<double>(flystick.joysticks)) || !line.close_block()) {
    return Target::kFailed;
  }
  return set_pose(matrix, position_mm, flystick);
}

/// `[id qu bt][x y z eta theta phi][b0 .. b8]`
Target read_old_flystick(Scanner& line, Flystick& flystick, LineMemory& memory) {
  std::uint32_t word = 0;
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(flystick.id) || !line.read(flystick.quality) ||
      !read_button_word(line, word) || !line.close_block() ||
      !read_position_and_angles(line, position_mm) || !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  flystick.buttons = memory.buttons.take();
  append_buttons(word, kOldButtons, flystick.buttons);
  flystick.joysticks = memory.joysticks.take();
  flystick.joysticks.push_back(direction(word, kOldLeft, kOldRight));
  flystick.joysticks.push_back(direction(word, kOldDown, kOldUp));
  return set_pose(matrix, position_mm, flystick);
}

}  // namespace

bool read_6df2(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  const auto read_target = [&](Scanner& scanner, Flystick& flystick) {
    return read_flystick(scanner, flystick, context.memory);
  };
  if (!read_defined_and_count(line, count) ||
      !read_targets(line, count, context.frame.flysticks, context, read_target)) {
    return false;
  }
  context.old_flysticks = 0;
  return true;
}

bool read_6df(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  const auto read_target = [&](Scanner& scanner, Flystick& flystick) {
    return read_old_flystick(scanner, flystick, context.memory);
  };
  if (!line.read_count(count) ||
      !read_targets(line, count, context.frame.flysticks, context, read_target)) {
    return false;
  }
  context.old_flysticks = count;
  return true;
}

}  // namespace handeye::dtrack
