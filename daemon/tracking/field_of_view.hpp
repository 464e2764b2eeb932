// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace handeye {

/// Finds what the optics leave visible of the sensor: an endoscope shows a bright disc on black,
/// often cut by the frame; a 4:3 picture within 16:9 has black bars.
///
/// One image may mislead: it is dark, a cavity touches the rim, light flares beyond it. So images
/// vote: what is lit in some of them belongs to the field, what is lit in hardly any does not. The
/// answer is looked at again ever more rarely, and changed only where it was clearly wrong, for
/// features near a rim that moves would come and go with it. Old votes fade: another field, of a
/// scope that was exchanged, is found within a minute. One stream of images.
class FieldOfView {
 public:
  /// `given`: the mask to use whatever the images show; empty: it is found.
  explicit FieldOfView(cv::Mat given = {});

  /// Takes the next image (CV_8UC1); returns where to look in it: CV_8UC1 of its size, 255 =
  /// usable, already eroded away from the rim; empty: everywhere (an ordinary camera, or nothing is
  /// known yet).
  const cv::Mat& look(const cv::Mat& grey);

  const cv::Mat& mask() const { return mask_; }

 private:
  bool is_due();
  bool vote(const cv::Mat& grey);
  void forget_half();
  void reconsider(cv::Size size);
  bool is_as_before();
  bool is_lit_outside();

  bool given_{false};
  cv::Mat mask_;
  cv::Mat field_;  ///< the mask before erosion, small
  int frames_to_skip_{0};
  int votes_{0};          ///< those that have faded by as much
  cv::Mat1f lit_votes_;   ///< images in which a pixel was lit; small
  cv::Mat1f brightness_;  ///< sum over them, relative to the bright parts
  // Kept for their memory; small.
  cv::Mat small_;
  cv::Mat lit_;
  cv::Mat found_;
  cv::Mat common_;
};

}  // namespace handeye
