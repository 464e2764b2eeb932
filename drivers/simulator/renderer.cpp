// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/renderer.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

/// Newton's steps end below this change of depth: the error left is of second order in it.
constexpr float kConvergedMm = 1e-2F;
constexpr int kMaxNewtonSteps = 8;

/// Rays longer than this would be an error of the motion: the view is some 80 to 200 mm deep.
constexpr double kFarthestMm = 2000.0;

/// The lamp sits beside the eye on the tip, in eye coordinates [mm].
constexpr float kLampRightMm = 2.5F;

cv::Mat2f rays_of(const CameraModel& camera) {
  cv::Mat2f rays(camera.height, camera.width);
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const auto ray = unproject(camera, {column, row});
      if (!ray) {
        throw UsageError(fmt::format(
            "camera: its distortion leaves pixel ({}, {}) without a ray; use a milder one", column,
            row));
      }
      rays(row, column) = {static_cast<float>(ray->x()), static_cast<float>(ray->y())};
    }
  }
  return rays;
}

Eigen::Array4f padded(const Eigen::Vector3d& vector) {
  Eigen::Array4f array = Eigen::Array4f::Zero();
  array.head<3>() = vector.cast<float>().array();
  return array;
}

}  // namespace

Renderer::Renderer(const Surface& surface, const CameraModel& camera, std::uint64_t seed,
                   const ImagingOptions& options)
    : surface_(&surface),
      camera_(camera),
      options_(options),
      sensor_(camera.width, seed, options.noise_grey),
      rays_(rays_of(camera)),
      depth_mm_(camera.height, camera.width) {
  if (options.highlights) film_.emplace(seed);
}

void Renderer::render(const Pose& surface_from_eye, std::uint64_t frame_number, cv::Mat& grey) {
  render_light(surface_from_eye, radiance_);
  sensor_.expose(radiance_, frame_number, {}, grey);
}

void Renderer::render_light(const Pose& surface_from_eye, cv::Mat1f& radiance) {
  const Eigen::Matrix3d rotation = surface_from_eye.linear();
  const View view{padded(surface_from_eye.translation()), padded(rotation.col(0)),
                  padded(rotation.col(1)), padded(rotation.col(2))};
  radiance.create(camera_.height, camera_.width);
  surface_->visit([&](const auto& kind) {
    for (int row = 0; row < camera_.height; ++row) {
      if (film_) {
        render_row<true>(kind, row, view, radiance[row]);
      } else {
        render_row<false>(kind, row, view, radiance[row]);
      }
    }
  });
}

float Renderer::depth_of_first_pixel(int row, const View& view) const {
  const cv::Vec2f ray = rays_(row, 0);
  const Eigen::Array4f direction = ray[0] * view.x_axis + ray[1] * view.y_axis + view.z_axis;
  const auto depth = surface_->intersect(view.origin.head<3>().cast<double>().matrix(),
                                         direction.head<3>().cast<double>().matrix(), kFarthestMm);
  return depth ? static_cast<float>(*depth) : static_cast<float>(kFarthestMm);
}

float Renderer::glint(const View& view, const Eigen::Array4f& point,
                      const Eigen::Array4f& direction, const Relief::Node& node) const {
  const Eigen::Array4f to_lamp = view.origin + kLampRightMm * view.x_axis - point;
  const Eigen::Array4f halfway =
      to_lamp.matrix().normalized().array() - direction.matrix().normalized().array();
  return film_->glint(point, node[1], node[2], halfway);
}

template <bool kWet, typename Kind>
void Renderer::render_row(const Kind& kind, int row, const View& view, float* out) {
  const cv::Vec2f* rays = rays_[row];
  float* depths = depth_mm_[row];
  const float* depths_above = row > 0 ? depth_mm_[row - 1] : nullptr;
  const auto pixel = static_cast<float>(1.0 / camera_.fx);
  const Eigen::Array4f to_next_column = pixel * view.x_axis;
  const Eigen::Array4f to_next_row = static_cast<float>(1.0 / camera_.fy) * view.y_axis;
  const auto light =
      static_cast<float>(options_.nominal_distance_mm * options_.nominal_distance_mm / 255.0);

  float depth = depth_of_first_pixel(row, view);
  for (int column = 0; column < camera_.width; ++column) {
    const Eigen::Array4f direction =
        rays[column][0] * view.x_axis + rays[column][1] * view.y_axis + view.z_axis;
    // The neighbours' plane predicts the depth to some micrometres.
    if (column > 0 && depths_above != nullptr) {
      depth += depths_above[column] - depths_above[column - 1];
    }

    Eigen::Array4f point;
    Relief::Node node;
    float approach = 0;
    for (int step = 0; step < kMaxNewtonSteps; ++step) {
      point = view.origin + depth * direction;
      node = kind.sample(point[0], point[1]);
      approach = node[1] * direction[0] + node[2] * direction[1] - direction[2];
      const float change = (point[2] - node[0]) / approach;
      depth += change;
      if (std::abs(change) < kConvergedMm) break;
    }
    depths[column] = depth;
    point = view.origin + depth * direction;

    // Lambert's law: the light comes along the ray, with the square of the distance.
    const float ray_squared =
        1.0F + rays[column][0] * rays[column][0] + rays[column][1] * rays[column][1];
    const float normal_squared = 1.0F + node[1] * node[1] + node[2] * node[2];
    const float cosine = approach / std::sqrt(ray_squared * normal_squared);
    const float distance_squared = depth * depth * ray_squared;

    const float albedo =
        kind.albedo({point, direction, to_next_column, to_next_row, depth, cosine, pixel});
    out[column] = albedo * light * std::max(cosine, 0.0F) / distance_squared;
    if constexpr (kWet) {
      const float mirrored = 255.0F * WetFilm::kShine * light / distance_squared;
      out[column] += mirrored * glint(view, point, direction, node);
    }
  }
}

}  // namespace handeye::simulator
