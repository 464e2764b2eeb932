// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/endoscope_view.hpp"

namespace handeye::simulator {

EndoscopeView::EndoscopeView(const World& world)
    : world_(&world),
      renderer_(world.surface, world.camera, world.options.seed,
                {.noise_grey = world.options.image_noise_grey,
                 .highlights = world.options.disturbances.highlights}),
      fates_(world.options.disturbances, world.options.seed, world.options.camera_rate_hz),
      flicker_(world.options.disturbances.flicker, world.options.seed) {
  const SimulatorOptions& options = world.options;
  if (options.disturbances.round_view) {
    field_stop_.emplace(options.width, options.height, options.seed);
  }
  if (options.disturbances.exposure_s > 0) motion_blur_.emplace(world.camera);
  if (options.disturbances.instrument) {
    instrument_.emplace(options.width, options.height, options.seed);
  }
}

double EndoscopeView::exposed_s(std::uint32_t number) const {
  return number / world_->options.camera_rate_hz;
}

void EndoscopeView::draw(std::uint32_t number, cv::Mat& grey) {
  const FrameFate fate = fates_.of(number);
  const double time_s = exposed_s(fate.shown);
  if (world_->options.disturbances.interlaced) {
    collect(time_s + 0.5 / world_->options.camera_rate_hz, later_radiance_);
  }
  collect(time_s, radiance_);
  for (int row = 1; row < later_radiance_.rows; row += 2) {
    later_radiance_.row(row).copyTo(radiance_.row(row));
  }
  if (fate.dark) radiance_ = 0;
  renderer_.sensor().expose(radiance_, fate.shown, flicker_.exposure(time_s), grey);
}

void EndoscopeView::collect(double time_s, cv::Mat1f& radiance) {
  const Disturbances& disturbances = world_->options.disturbances;
  const Pose surface_from_eye = world_->surface_from_eye(time_s);
  renderer_.render_light(surface_from_eye, radiance);
  depth_mm_ = renderer_.depth_mm();
  if (motion_blur_) {
    const double half_s = 0.5 * disturbances.exposure_s;
    motion_blur_->apply(
        depth_mm_, world_->surface_from_eye(time_s - half_s).inverse() * surface_from_eye,
        world_->surface_from_eye(time_s + half_s).inverse() * surface_from_eye, radiance);
  }
  if (instrument_) {
    depth_mm_ = depth_mm_.clone();  // the renderer's own starts its next picture
    instrument_->draw(time_s, radiance, depth_mm_);
  }
  defocus(disturbances.defocus_px, radiance);
  if (field_stop_) field_stop_->apply(radiance);
}

}  // namespace handeye::simulator
