// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/renderer.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "drivers/simulator/random_stream.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

constexpr std::size_t kNoiseTable = 1 << 16;

/// Newton's steps end below this change of depth: the error left is of second order in it.
constexpr float kConvergedMm = 1e-2F;
constexpr int kMaxNewtonSteps = 8;

/// Rays longer than this would be an error of the motion: the view is some 80 to 200 mm deep.
constexpr double kFarthestMm = 2000.0;

/// Well mixed bits of two numbers (the finaliser of splitmix64).
std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t bits = a + 0x9e3779b97f4a7c15ULL * (b + 1);
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

/// Grey level of a radiance (1: a white surface, straight on, at the nominal distance): a camera
/// head's soft shoulder instead of clipping.
float tone(float radiance) {
  return 470.0F * radiance / (radiance + 1.3F);
}

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
      rays_(rays_of(camera)),
      depth_mm_(camera.height, camera.width),
      noise_(kNoiseTable + static_cast<std::size_t>(camera.width)),
      seed_(seed) {
  RandomStream random(seed, Purpose::kImageNoise);
  for (float& value : noise_) value = static_cast<float>(random.normal(options.noise_grey));
}

void Renderer::render(const Pose& surface_from_eye, std::uint64_t frame_number, cv::Mat& grey) {
  const Eigen::Matrix3d rotation = surface_from_eye.linear();
  const View view{padded(surface_from_eye.translation()), padded(rotation.col(0)),
                  padded(rotation.col(1)), padded(rotation.col(2))};
  grey.create(camera_.height, camera_.width, CV_8UC1);
  const std::uint64_t frame_bits = mix(seed_, frame_number);
  surface_->visit([&](const auto& kind) {
    for (int row = 0; row < camera_.height; ++row) {
      const std::uint64_t offset = mix(frame_bits, static_cast<std::uint64_t>(row)) % kNoiseTable;
      render_row(kind, row, view, noise_.data() + offset, grey.ptr<std::uint8_t>(row));
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

template <typename Kind>
void Renderer::render_row(const Kind& kind, int row, const View& view, const float* noise,
                          std::uint8_t* out) {
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
    const float radiance = albedo * light * std::max(cosine, 0.0F) / distance_squared;
    const float value = tone(radiance) + noise[column] + 0.5F;
    out[column] = static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
  }
}

}  // namespace handeye::simulator
