// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/surface.hpp"

namespace handeye::simulator {
namespace {

/// What optics and sensor together spread a point over, in pixels: the side of a box. Its standard
/// deviation, 0.72 px, is that of a good endoscope in focus.
constexpr float kBlurPx = 2.5F;

/// Distance to the plane z = 0 along a ray that comes down to it.
std::optional<double> meet_plane(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                 double limit) {
  if (origin.z() < 0 || direction.z() >= 0) return std::nullopt;
  const double along = -origin.z() / direction.z();
  return along <= limit ? std::optional(along) : std::nullopt;
}

}  // namespace

std::optional<double> FlatTissue::intersect(const Eigen::Vector3d& origin,
                                            const Eigen::Vector3d& direction, double limit) const {
  return meet_plane(origin, direction, limit);
}

FlatBoard::FlatBoard(const Board& board)
    : picture_(board),
      middle_mm_(0.5 * picture_.width_mm() - picture_.first_corner_mm(),
                 0.5 * picture_.height_mm() - picture_.first_corner_mm()) {}

Pose FlatBoard::surface_from_board() const {
  Pose surface_from_board = Pose::Identity();
  surface_from_board.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  surface_from_board.translation() = Eigen::Vector3d(-middle_mm_.x(), middle_mm_.y(), 0);
  return surface_from_board;
}

std::optional<double> FlatBoard::intersect(const Eigen::Vector3d& origin,
                                           const Eigen::Vector3d& direction, double limit) const {
  return meet_plane(origin, direction, limit);
}

float FlatBoard::albedo(const PixelRay& ray) const {
  // How far the point moves on the plane from this pixel to the next column and row.
  const auto moved = [&ray](const Eigen::Array4f& change) -> Eigen::Array4f {
    return ray.depth_mm * (change - ray.direction * (change[2] / ray.direction[2]));
  };
  const Eigen::Array4f along_column = moved(ray.to_next_column);
  const Eigen::Array4f along_row = moved(ray.to_next_row);
  // The box of the same variance along both axes as the pixel's outline. It is symmetric about the
  // point, as the outline is, so corners stay where they are.
  return picture_.mean(
      {.centre_x = static_cast<double>(ray.point[0]) + middle_mm_.x(),
       .centre_y = middle_mm_.y() - static_cast<double>(ray.point[1]),
       .width = static_cast<double>(kBlurPx * std::hypot(along_column[0], along_row[0])),
       .height = static_cast<double>(kBlurPx * std::hypot(along_column[1], along_row[1]))});
}

Surface::Kind Surface::kind_of(std::uint64_t seed, SceneKind scene) {
  switch (scene) {
    case SceneKind::kPlane:
      return Kind(std::in_place_type<FlatTissue>, seed);
    case SceneKind::kBare:
      return Kind(std::in_place_type<BareHills>, seed);
    case SceneKind::kTissue:
      break;
  }
  return Kind(std::in_place_type<Tissue>, seed);
}

Surface::Surface(std::uint64_t seed, SceneKind scene) : kind_(kind_of(seed, scene)) {}

std::optional<Pose> Surface::surface_from_board() const {
  const auto* const board = std::get_if<FlatBoard>(&kind_);
  return board != nullptr ? std::optional(board->surface_from_board()) : std::nullopt;
}

}  // namespace handeye::simulator
