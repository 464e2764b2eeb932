// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "daemon/config/config.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "daemon/service/pose_publisher.hpp"
#include "daemon/service/solver_thread.hpp"
#include "daemon/service/vision_thread.hpp"
#include "protocol/channels.hpp"

namespace handeye {

/// What the configuration's files say about the camera, read and checked.
struct CameraFiles {
  CameraModel model;
  cv::Mat mask;  ///< empty: found in the images
};

/// Reads them. Throws InputError: unreadable, unusable, or of different sizes.
CameraFiles read_camera_files(const Config::Camera& config);

// What the configuration says to each part of the daemon.

VisionThread::Options vision_options(const Config& config, const CameraFiles& files,
                                     const Channels& channels);
SolverThread::Options solver_options(const Config& config, const CameraFiles& files);
PosePublisherOptions pose_options(const Config::CameraPose& config);

}  // namespace handeye
