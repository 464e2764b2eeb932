// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "drivers/dtrack/blocks.hpp"
#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/target_list.hpp"

namespace handeye::dtrack {
namespace {

constexpr std::int32_t kFewFingers = 3;
constexpr std::int32_t kAllFingers = 5;

/// `[x y z][b0 .. b8][r l1 a12 l2 a23 l3]`
Target read_finger(Scanner& line, Finger& finger) {
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  std::array<double, 6> shape;
  if (!read_position(line, position_mm) || !read_matrix(line, matrix) || !line.read_block(shape)) {
    return Target::kFailed;
  }
  finger.tip_radius_mm = shape[0];
  finger.phalanx_length_mm = {shape[1], shape[3], shape[5]};
  finger.joint_angle_rad = {rad_from_deg(shape[2]), rad_from_deg(shape[4])};
  return make_pose_of_printed(matrix, position_mm, finger.hand_from_fingertip)
             ? Target::kTaken
             : Target::kBadRotation;
}

/// `[id qu lr nf][x y z][b0 .. b8]`, then the fingers. A hand is refused as a whole if one of its
/// matrices is no rotation, for its fingers are told apart by their place.
Target read_hand(Scanner& line, FingertrackingHand& hand, LineMemory& memory) {
  std::int32_t right = 0;
  std::int32_t finger_count = 0;
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(hand.id) || !line.read(hand.quality) ||
      !line.read(right, 0, 1) || !line.read_count(finger_count, kAllFingers) ||
      !line.close_block() || !read_position(line, position_mm) || !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  if (finger_count != kFewFingers && finger_count != kAllFingers) {
    return taken_if(line.fail(ErrorKind::kBadCount));
  }
  hand.right = right == 1;
  hand.fingers = memory.fingers.take();
  bool good_rotations = true;
  for (std::int32_t i = 0; i < finger_count; ++i) {
    const Target finger = read_finger(line, hand.fingers.emplace_back());
    if (finger == Target::kFailed) return finger;
    good_rotations = good_rotations && finger == Target::kTaken;
  }
  if (hand.quality < 0) return Target::kLeftOut;
  good_rotations =
      make_pose_of_printed(matrix, position_mm, hand.room_from_hand_back) && good_rotations;
  return good_rotations ? Target::kTaken : Target::kBadRotation;
}

}  // namespace

bool read_gl(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  const auto read_target = [&](Scanner& scanner, FingertrackingHand& hand) {
    return read_hand(scanner, hand, context.memory);
  };
  return line.read_count(count) &&
         read_targets(line, count, context.frame.hands, context, read_target);
}

}  // namespace handeye::dtrack
