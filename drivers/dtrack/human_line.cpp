// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "drivers/dtrack/blocks.hpp"
#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/target_list.hpp"

namespace handeye::dtrack {
namespace {

/// `[jid qu][x y z a b c][b0 .. b8]`
Target read_joint(Scanner& line, Joint& joint) {
  std::array<double, 6> position_and_angles;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(joint.id) || !line.read(joint.quality) ||
      !line.close_block() || !line.read_block(position_and_angles) || !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  const auto& [x, y, z, a, b, c] = position_and_angles;
  joint.relative_angle_rad = {rad_from_deg(a), rad_from_deg(b), rad_from_deg(c)};
  joint.tracked = joint.quality >= 0;
  if (!joint.tracked) return Target::kTaken;
  return make_pose_of_printed(matrix, {x, y, z}, joint.room_from_joint) ? Target::kTaken
                                                                        : Target::kBadRotation;
}

/// `[id nj]`, then the joints. A joint whose matrix is no rotation is left out and counted.
Target read_human(Scanner& line, HumanModel& human, LineContext& context) {
  std::int32_t joint_count = 0;
  if (!line.open_block() || !line.read_id(human.id) || !line.read_count(joint_count, kMaxJoints) ||
      !line.close_block()) {
    return Target::kFailed;
  }
  if (joint_count > 0) human.joints = context.memory.joints.take();
  ListUpdate<Joint> update(human.joints, context);
  for (std::int32_t i = 0; i < joint_count; ++i) {
    const Target joint = read_joint(line, update.append());
    if (joint == Target::kFailed) return joint;
    update.settle_last(joint);
  }
  update.commit();
  return Target::kTaken;
}

}  // namespace

bool read_6dj(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  const auto read_target = [&](Scanner& scanner, HumanModel& human) {
    return read_human(scanner, human, context);
  };
  return read_defined_and_count(line, count) &&
         read_targets(line, count, context.frame.humans, context, read_target);
}

}  // namespace handeye::dtrack
