// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "drivers/recording/camera_file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

/// OpenCV's parser demands a %YAML line, which ROS does not write.
std::string with_yaml_header(const std::string& text) {
  if (text.starts_with('%') || text.starts_with('<')) return text;
  return (text.starts_with("---") ? "%YAML:1.0\n" : "%YAML:1.0\n---\n") + text;
}

/// Strict access to the keys of a camera file. Both kinds write a matrix as rows, cols, data.
class CameraNodes {
 public:
  CameraNodes(const std::filesystem::path& path, const std::string& text) : path_(path) {
    try {
      storage_.open(with_yaml_header(text), cv::FileStorage::READ | cv::FileStorage::MEMORY);
    } catch (const cv::Exception&) {
      storage_.release();
    }
    if (!storage_.isOpened()) {
      throw InputError(fmt::format(
          "{}: neither OpenCV's YAML or XML nor a ROS camera_info file; use camera.json",
          path_.string()));
    }
  }

  int integer(const std::string& key) const {
    const cv::FileNode node = at(key);
    if (!node.isInt()) fail(key, "must be a whole number");
    return static_cast<int>(node);
  }

  std::vector<double> matrix(const std::string& key) const {
    const cv::FileNode node = at(key);
    const cv::FileNode data = node.isMap() ? node["data"] : cv::FileNode();
    if (!data.isSeq()) fail(key, "must be a matrix (rows, cols, data)");
    std::vector<double> values;
    for (const cv::FileNode element : data) {
      if (!element.isReal() && !element.isInt()) fail(key, "must hold numbers");
      values.push_back(static_cast<double>(element));
    }
    const cv::FileNode rows = node["rows"];
    const cv::FileNode cols = node["cols"];
    if (!rows.isInt() || !cols.isInt() ||
        static_cast<double>(rows) * static_cast<double>(cols) !=
            static_cast<double>(values.size())) {
      fail(key, "does not hold rows x cols numbers");
    }
    return values;
  }

  /// Refuses models other than the pinhole with k1, k2, p1, p2, k3, where the file names one.
  void require_plain_model() const {
    const cv::FileNode ros_model = storage_["distortion_model"];
    if (!ros_model.empty() &&
        (!ros_model.isString() ||
         (ros_model.string() != "plumb_bob" && ros_model.string() != "rational_polynomial"))) {
      fail("distortion_model", "must be plumb_bob; calibrate with that model");
    }
    const cv::FileNode fisheye = storage_["fisheye_model"];
    if (!fisheye.empty() && (!fisheye.isInt() || static_cast<int>(fisheye) != 0)) {
      fail("fisheye_model", "must be 0; calibrate with the ordinary model");
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw InputError(fmt::format("{}: {} {}", path_.string(), key, what));
  }

 private:
  cv::FileNode at(const std::string& key) const {
    cv::FileNode node = storage_[key];
    if (node.empty()) fail(key, "is missing");
    return node;
  }

  const std::filesystem::path& path_;
  cv::FileStorage storage_;
};

}  // namespace

CameraModel parse_camera_file_storage(const std::filesystem::path& path, const std::string& text) {
  const CameraNodes file(path, text);
  file.require_plain_model();
  CameraModel camera;
  camera.width = file.integer("image_width");
  camera.height = file.integer("image_height");

  const std::vector<double> k = file.matrix("camera_matrix");
  if (k.size() != 9) file.fail("camera_matrix", "must be 3x3");
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    file.fail("camera_matrix", "must be [fx 0 cx; 0 fy cy; 0 0 1]");
  }
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];

  const std::string distortion_key = "distortion_coefficients";
  set_distortion(camera, file.matrix(distortion_key), path, distortion_key);
  return camera;
}

}  // namespace handeye
