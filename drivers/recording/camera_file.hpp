// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/geometry/camera_model.hpp"

namespace handeye {

/// Reads the two kinds of file that OpenCV's FileStorage can parse: what OpenCV's calibration
/// sample writes (.yml, .xml), and ROS camera_info (.yaml). `text`: the file's whole content;
/// `path`: for messages. Throws InputError.
CameraModel parse_camera_file_storage(const std::filesystem::path& path, const std::string& text);

/// Puts k1, k2, p1, p2(, k3) where they belong. Further coefficients (OpenCV knows up to 14) must
/// be 0. Throws InputError that names the key.
void set_distortion(CameraModel& camera, const std::vector<double>& coefficients,
                    const std::filesystem::path& path, const std::string& key);

}  // namespace handeye
