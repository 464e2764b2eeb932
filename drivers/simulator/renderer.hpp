// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core.hpp>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "drivers/simulator/sensor.hpp"
#include "drivers/simulator/surface.hpp"
#include "drivers/simulator/wet_film.hpp"

namespace handeye::simulator {

struct ImagingOptions {
  double nominal_distance_mm{80.0};  ///< where the light's brightness is set for
  double noise_grey{1.5};            ///< standard deviation of the image noise, grey levels
  bool highlights{false};            ///< the surface is wet
};

/// Draws what the endoscope sees by casting one ray a pixel, through the lens as it is, against the
/// surface as it is: the reprojection of a surface point is where its texture shows, to well below
/// 0.01 px. The light sits at the tip and falls off with the square of the distance.
///
/// One thread a renderer; several may share a surface, which must outlive them.
class Renderer {
 public:
  /// Throws UsageError when a pixel of the camera has no ray (distortion not invertible).
  Renderer(const Surface& surface, const CameraModel& camera, std::uint64_t seed,
           const ImagingOptions& options = {});

  /// Draws a CV_8UC1 image; memory is kept when the size stays. The eye must be above the surface
  /// and look down on it. `frame_number` picks the image noise.
  void render(const Pose& surface_from_eye, std::uint64_t frame_number, cv::Mat& grey);

  /// The light alone, before the sensor; 1: a white surface, straight on, at the nominal distance.
  void render_light(const Pose& surface_from_eye, cv::Mat1f& radiance);

  const Sensor& sensor() const { return sensor_; }

  /// Depth (z in the eye frame, mm) of every pixel of the last image.
  const cv::Mat1f& depth_mm() const { return depth_mm_; }

 private:
  /// Where the rays start and how to turn them into surface coordinates, in single precision.
  struct View {
    Eigen::Array4f origin, x_axis, y_axis, z_axis;
  };

  template <bool kWet, typename Kind>
  void render_row(const Kind& kind, int row, const View& view, float* out);
  float glint(const View& view, const Eigen::Array4f& point, const Eigen::Array4f& direction,
              const Relief::Node& node) const;
  float depth_of_first_pixel(int row, const View& view) const;

  const Surface* surface_;
  CameraModel camera_;
  ImagingOptions options_;
  Sensor sensor_;
  std::optional<WetFilm> film_;
  cv::Mat2f rays_;      ///< x/z and y/z of every pixel
  cv::Mat1f depth_mm_;  ///< also the start value for the neighbours below and to the right
  cv::Mat1f radiance_;  ///< of `render`
};

}  // namespace handeye::simulator
