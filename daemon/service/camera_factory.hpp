// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "daemon/config/config.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "drivers/camera.hpp"

namespace handeye {

/// The camera that the configuration names; not opened yet. A new kind of camera is a folder under
/// drivers/ and a case here.
std::unique_ptr<Camera> make_camera(const Config& config, const CameraModel& model);

}  // namespace handeye
