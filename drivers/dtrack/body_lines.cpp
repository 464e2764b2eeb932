// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "drivers/dtrack/blocks.hpp"
#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/target_list.hpp"

namespace handeye::dtrack {
namespace {

constexpr std::int32_t kInertialOff = 0;
constexpr std::int32_t kInertialAndOptical = 3;

/// `[id qu][x y z eta theta phi][b0 .. b8]`
Target read_body(Scanner& line, Body& body) {
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(body.id) || !line.read(body.quality) ||
      !line.close_block() || !read_position_and_angles(line, position_mm) ||
      !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  body.tracked = body.quality >= 0;
  if (!body.tracked) return Target::kTaken;
  return make_pose_of_printed(matrix, position_mm, body.room_from_body) ? Target::kTaken
                                                                        : Target::kBadRotation;
}

/// `[id st er][x y z][b0 .. b8]`
Target read_hybrid_body(Scanner& line, Body& body) {
  double drift_deg = 0;
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d matrix;
  if (!line.open_block() || !line.read_id(body.id) ||
      !line.read(body.inertial_state, kInertialOff, kInertialAndOptical) || !line.read(drift_deg) ||
      !line.close_block() || !read_position(line, position_mm) || !read_matrix(line, matrix)) {
    return Target::kFailed;
  }
  body.tracked = body.inertial_state != kInertialOff;
  body.quality = body.tracked ? 1.0 : -1.0;
  body.inertial_drift_rad = rad_from_deg(drift_deg);
  if (!body.tracked) return Target::kTaken;
  return make_pose_of_printed(matrix, position_mm, body.room_from_body) ? Target::kTaken
                                                                        : Target::kBadRotation;
}

/// `[id x y z][c11 c12 .. c16 c22 .. c66]`: the upper triangle row by row.
Target read_covariance(Scanner& line, BodyCovariance& body) {
  std::array<double, 21> upper;
  if (!line.open_block() || !line.read_id(body.id) ||
      !line.read({body.reference_point_mm.data(), 3}) || !line.close_block() ||
      !line.read_block(upper)) {
    return Target::kFailed;
  }
  const double* value = upper.data();
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      body.covariance(row, column) = body.covariance(column, row) = *value++;
    }
  }
  return Target::kTaken;
}

}  // namespace

bool read_6d(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  return line.read_count(count) &&
         read_targets(line, count, context.frame.bodies, context, read_body);
}

bool read_6di(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  return line.read_count(count) &&
         read_targets(line, count, context.memory.hybrid_bodies, context, read_hybrid_body);
}

bool read_6dcov(Scanner& line, LineContext& context) {
  std::int32_t count = 0;
  return line.read_count(count) &&
         read_targets(line, count, context.frame.covariances, context, read_covariance);
}

}  // namespace handeye::dtrack
