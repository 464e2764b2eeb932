// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "daemon/tracking/block_means.hpp"
#include "daemon/tracking/image_condition.hpp"
#include "daemon/tracking/repeated_image.hpp"
#include "daemon/tracking/sharpness.hpp"

namespace handeye {

/// Tells what is wrong with an image before anything is sought in it. Reads a part of it only: a
/// tenth of a millisecond. One stream of images; memory is kept.
class ImageInspector {
 public:
  /// Looks at the next image (CV_8UC1). The first that applies: kDark, kFrozen, kBright, kBlurred;
  /// else kGood. Interlacing is FieldSeparation's to see.
  ImageCondition inspect(const cv::Mat& grey);

  /// Of the last image that was neither dark nor frozen, beside those before it; 0..1.
  double sharpness() const { return sharpness_now_; }

 private:
  BlockMeans blocks_;
  RepeatedImage repeated_;
  Sharpness sharpness_;
  double sharpness_now_{1};
};

}  // namespace handeye
