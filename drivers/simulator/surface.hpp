// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>

#include "daemon/geometry/board.hpp"
#include "daemon/geometry/pose.hpp"
#include "drivers/simulator/board_picture.hpp"
#include "drivers/simulator/relief.hpp"
#include "drivers/simulator/scene_kind.hpp"
#include "drivers/simulator/texture.hpp"

/// What is looked at, in surface coordinates (mm, z towards the viewer). Each kind says its height
/// and slopes (`sample`), where a ray meets it (`intersect`), and what a pixel sees (`albedo`).
namespace handeye::simulator {

/// The ray of a pixel and where it meets the surface; single precision, padded by a fourth number.
struct PixelRay {
  Eigen::Array4f point;                        ///< on the surface
  Eigen::Array4f direction;                    ///< from the eye, as long as one mm of depth
  Eigen::Array4f to_next_column, to_next_row;  ///< change of the direction to the next pixel
  float depth_mm;
  float cosine;  ///< between the ray and the surface's normal
  float pixel;   ///< a pixel's width over its depth

  /// What the pixel covers of the surface, along its longer side.
  float footprint_mm() const { return depth_mm * pixel / std::max(cosine, 0.1F); }
};

/// The lining of a body cavity.
class Tissue {
 public:
  explicit Tissue(std::uint64_t seed) : relief_(seed), texture_(seed) {}

  double height(double x_mm, double y_mm) const { return relief_.height(x_mm, y_mm); }
  Relief::Node sample(float x_mm, float y_mm) const { return relief_.sample(x_mm, y_mm); }
  std::optional<double> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double limit) const {
    return relief_.intersect(origin, direction, limit);
  }
  float albedo(const PixelRay& ray) const {
    return texture_.sample(ray.point[0], ray.point[1], ray.footprint_mm());
  }

 private:
  Relief relief_;
  Texture texture_;
};

/// The same lining stretched flat.
class FlatTissue {
 public:
  explicit FlatTissue(std::uint64_t seed) : texture_(seed) {}

  double height(double, double) const { return 0; }
  Relief::Node sample(float, float) const { return Relief::Node::Zero(); }
  std::optional<double> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double limit) const;
  float albedo(const PixelRay& ray) const {
    return texture_.sample(ray.point[0], ray.point[1], ray.footprint_mm());
  }

 private:
  Texture texture_;
};

/// The hills of the lining without anything on them.
class BareHills {
 public:
  explicit BareHills(std::uint64_t seed) : relief_(seed) {}

  double height(double x_mm, double y_mm) const { return relief_.height(x_mm, y_mm); }
  Relief::Node sample(float x_mm, float y_mm) const { return relief_.sample(x_mm, y_mm); }
  std::optional<double> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double limit) const {
    return relief_.intersect(origin, direction, limit);
  }
  float albedo(const PixelRay&) const { return kAlbedo; }

 private:
  static constexpr float kAlbedo = 130.0F;  ///< the lining's mean

  Relief relief_;
};

/// A calibration board that lies flat, its middle at the origin, upright for a viewer who looks
/// straight down.
class FlatBoard {
 public:
  explicit FlatBoard(const Board& board);

  double height(double, double) const { return 0; }
  Relief::Node sample(float, float) const { return Relief::Node::Zero(); }
  std::optional<double> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double limit) const;
  float albedo(const PixelRay& ray) const;

  /// x stays; y and z turn over.
  Pose surface_from_board() const;

 private:
  BoardPicture picture_;
  Eigen::Vector2d middle_mm_;  ///< of the board, in its frame
};

class Surface {
 public:
  explicit Surface(std::uint64_t seed, SceneKind scene = SceneKind::kTissue);

  /// Throws UsageError when the board cannot be drawn.
  explicit Surface(const Board& board) : kind_(std::in_place_type<FlatBoard>, board) {}

  /// Calls the visitor with the kind: once an image, not once a pixel.
  template <typename Visitor>
  decltype(auto) visit(Visitor&& visitor) const {
    return std::visit(std::forward<Visitor>(visitor), kind_);
  }

  double height(double x_mm, double y_mm) const {
    return visit([&](const auto& kind) { return kind.height(x_mm, y_mm); });
  }

  /// Distance along the ray in units of |direction|; nothing when it does not come down to the
  /// surface within `limit`.
  std::optional<double> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double limit) const {
    return visit([&](const auto& kind) { return kind.intersect(origin, direction, limit); });
  }

  /// Nothing where there is no board.
  std::optional<Pose> surface_from_board() const;

 private:
  using Kind = std::variant<Tissue, FlatTissue, BareHills, FlatBoard>;

  static Kind kind_of(std::uint64_t seed, SceneKind scene);

  Kind kind_;
};

}  // namespace handeye::simulator
