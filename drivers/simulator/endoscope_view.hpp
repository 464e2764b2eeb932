// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core.hpp>

#include "drivers/simulator/blur.hpp"
#include "drivers/simulator/field_stop.hpp"
#include "drivers/simulator/flicker.hpp"
#include "drivers/simulator/frame_fate.hpp"
#include "drivers/simulator/instrument.hpp"
#include "drivers/simulator/renderer.hpp"
#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// The pictures of a world's endoscope, disturbed as the world's options say: light from the scene,
/// what comes between, optics, sensor. Any frame can be drawn at any time, in any order, and looks
/// the same. One thread an object; several may share the world, which must outlive them.
class EndoscopeView {
 public:
  explicit EndoscopeView(const World& world);

  /// Simulated time of a frame's mid-exposure; of its even lines where it is interlaced.
  double exposed_s(std::uint32_t number) const;

  /// Whether the frame arrives at all (it can be drawn anyway), is dark or frozen.
  FrameFate fate(std::uint32_t number) const { return fates_.of(number); }

  /// CV_8UC1 of the camera's size; memory is kept when the size stays.
  void draw(std::uint32_t number, cv::Mat& grey);

  /// Depth (z in the eye frame, mm) behind every pixel of the last picture, interlaced ones as its
  /// even lines see it; 0 where an instrument hides the scene. Of dark frames: what light would
  /// show.
  const cv::Mat1f& depth_mm() const { return depth_mm_; }

 private:
  void collect(double time_s, cv::Mat1f& radiance);

  const World* world_;
  Renderer renderer_;
  FrameFates fates_;
  Flicker flicker_;
  std::optional<FieldStop> field_stop_;
  std::optional<MotionBlur> motion_blur_;
  std::optional<Instrument> instrument_;
  cv::Mat1f radiance_, later_radiance_, depth_mm_;
};

}  // namespace handeye::simulator
