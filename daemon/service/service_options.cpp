// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/service_options.hpp"

#include <fmt/format.h>

#include "drivers/recording/recording.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {

CameraFiles read_camera_files(const Config::Camera& config) {
  CameraFiles files;
  if (config.intrinsics.empty()) {
    files.model.width = config.width;
    files.model.height = config.height;
  } else {
    files.model = read_camera_model(config.intrinsics);
  }
  if (!config.mask.empty()) files.mask = read_mask(config.mask);
  const cv::Size size(files.model.width, files.model.height);
  if (!files.mask.empty() && files.mask.size() != size) {
    const std::string camera =
        config.intrinsics.empty() ? "the camera" : config.intrinsics.string();
    throw InputError(fmt::format("{}: the mask is {}x{}, but {} is for {}x{}", config.mask.string(),
                                 files.mask.cols, files.mask.rows, camera, size.width,
                                 size.height));
  }
  return files;
}

VisionThread::Options vision_options(const Config& config, const CameraFiles& files,
                                     const Channels& channels) {
  VisionThread::Options options;
  options.mask = files.mask;
  options.lens = known_lens(files.model, config.camera.intrinsics_mode);
  // A camera on LCM is on FRAME already; never publish there beside it.
  if (config.camera.driver != Config::Camera::Driver::kLcm) options.frame_channel = channels.frame;
  return options;
}

SolverThread::Options solver_options(const Config& config, const CameraFiles& files) {
  SolverThread::Options options{
      .camera = files.model, .intrinsics = config.camera.intrinsics_mode, .noise = {}};
  options.noise.hand_rotation_rad = rad_from_deg(config.tracker.noise_rotation_deg);
  options.noise.hand_translation_mm = config.tracker.noise_translation_mm;
  options.hand_noise = config.tracker.noise;
  options.min_duration_s = config.calibration.min_duration_s;
  return options;
}

PosePublisherOptions pose_options(const Config::CameraPose& config) {
  const auto ns = [](double duration_ms) { return static_cast<std::int64_t>(1e6 * duration_ms); };
  return {.wait_ns = ns(config.wait_ms), .predict_ns = ns(config.predict_ms)};
}

}  // namespace handeye
