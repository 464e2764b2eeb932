// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/camera_factory.hpp"

#include "drivers/lcm/lcm_camera.hpp"
#include "drivers/v4l2/v4l2_camera.hpp"

namespace handeye {
namespace {

std::unique_ptr<Camera> make_lcm_camera(const Config& config) {
  LcmCameraOptions options;
  options.provider_url = config.lcm.url;
  options.channel = Channels(config.lcm.prefix).frame;
  options.any_clock = true;  // the camera thread's FrameClock looks after it
  return std::make_unique<LcmCamera>(options);
}

std::unique_ptr<Camera> make_v4l2_camera(const Config::Camera& config, const CameraModel& model) {
  V4l2CameraOptions options;
  options.device = config.device;
  options.wish.width = config.width > 0 ? config.width : model.width;
  options.wish.height = config.height > 0 ? config.height : model.height;
  options.wish.rate_hz = config.rate_hz;
  options.half_exposure_ns = static_cast<std::int64_t>(0.5e6 * config.exposure_ms);
  return std::make_unique<V4l2Camera>(options);
}

}  // namespace

std::unique_ptr<Camera> make_camera(const Config& config, const CameraModel& model) {
  switch (config.camera.driver) {
    case Config::Camera::Driver::kLcm:
      return make_lcm_camera(config);
    case Config::Camera::Driver::kV4l2:
      break;
  }
  return make_v4l2_camera(config.camera, model);
}

}  // namespace handeye
