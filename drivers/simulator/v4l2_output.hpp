// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace handeye::simulator {

/// The writing end of a video device that shows programs what is written to it, as the kernel
/// module v4l2loopback makes them: the simulated endoscope becomes a camera of this machine.
class V4l2Output {
 public:
  /// Grey pictures of this size [px] from now on. Throws InputError when the device is not there,
  /// takes no pictures or none of these.
  V4l2Output(const std::string& path, int width, int height);
  ~V4l2Output();
  V4l2Output(const V4l2Output&) = delete;
  V4l2Output& operator=(const V4l2Output&) = delete;

  /// One picture, CV_8UC1 and continuous, stamped by the kernel as it is written. False: it was not
  /// taken.
  bool show(const cv::Mat& grey) const;

 private:
  void choose_format(int width, int height) const;

  std::string path_;
  int descriptor_{-1};
};

}  // namespace handeye::simulator
