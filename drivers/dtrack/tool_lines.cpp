// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <bit>

#include "drivers/dtrack/blocks.hpp"
#include "drivers/dtrack/buttons.hpp"
#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/target_list.hpp"

namespace handeye::dtrack {
namespace {

Target set_pose(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& position_mm,
                MeasurementTool& tool) {
  tool.tracked = tool.quality >= 0;
  if (!tool.tracked) return Target::kTaken;
  return make_pose_of_printed(matrix, position_mm, tool.room_from_tool) ? Target::kTaken
                                                                        : Target::kBadRotation;
}

/// `[s11 s12 s13 s22 s23 s33]`, mm^2
bool read_tip_covariance(Scanner& line, Eigen::Matrix3d& covariance_mm2) {
  std::array<double, 6> s;
  if (!line.read_block(s)) return false;
  covariance_mm2 << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return true;
}

/// `[id qu nbt rd][x y z][b0 .. b8][button words][s11 .. s33]`
Target read_tool(Scanner& line, MeasurementTool& tool, LineMemory& memory) {
  std::int32_t buttons = 0;
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(tool.id) || !line.read(tool.quality) ||
      !line.read_count(buttons, kMaxButtons) || !line.read(tool.tip_radius_mm) ||
      !line.close_block() || !read_position(line, position_mm) || !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  if (buttons > 0) tool.buttons = memory.buttons.take();
  if (!line.open_block() || !read_buttons(line, buttons, tool.buttons) || !line.close_block() ||
      !read_tip_covariance(line, tool.tip_covariance_mm2)) {
    return Target::kFailed;
  }
  return set_pose(matrix, position_mm, tool);
}

/// `[id qu bt][x y z][b0 .. b8]`. The format does not tell how many buttons there are; they end
/// with the last one that is pressed.
Target read_old_tool(Scanner& line, MeasurementTool& tool, LineMemory& memory) {
  std::uint32_t word = 0;
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(tool.id) || !line.read(tool.quality) ||
      !read_button_word(line, word) || !line.close_block() || !read_position(line, position_mm) ||
      !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  if (word != 0) tool.buttons = memory.buttons.take();
  append_buttons(word, static_cast<std::int32_t>(std::bit_width(word)), tool.buttons);
  return set_pose(matrix, position_mm, tool);
}

/// `[id qu][x y z][b0 .. b8]`
Target read_tool_reference(Scanner& line, ToolReference& reference) {
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(reference.id) || !line.read(reference.quality) ||
      !line.close_block() || !read_position(line, position_mm) || !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  if (reference.quality < 0) return Target::kLeftOut;
  return make_pose_of_printed(matrix, position_mm, reference.room_from_reference)
             ? Target::kTaken
             : Target::kBadRotation;
}

}  // namespace

bool read_6dmt2(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  const auto read_target = [&](Scanner& scanner, MeasurementTool& tool) {
    return read_tool(scanner, tool, context.memory);
  };
  if (!read_defined_and_count(line, count) ||
      !read_targets(line, count, context.frame.tools, context, read_target)) {
    return false;
  }
  context.old_tools = 0;
  return true;
}

bool read_6dmt(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  const auto read_target = [&](Scanner& scanner, MeasurementTool& tool) {
    return read_old_tool(scanner, tool, context.memory);
  };
  if (!line.read_count(count) ||
      !read_targets(line, count, context.frame.tools, context, read_target)) {
    return false;
  }
  context.old_tools = count;
  return true;
}

bool read_6dmtr(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  return read_defined_and_count(line, count) &&
         read_targets(line, count, context.frame.tool_references, context, read_tool_reference);
}

}  // namespace handeye::dtrack
