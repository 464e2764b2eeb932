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
  /// Looks at the next image. The first that applies: kUnusable (empty, or not CV_8UC1), kDark,
  /// kFrozen, kBright, kBlurred; else kGood. Interlacing is FieldSeparation's to see.
  ImageCondition inspect(const cv::Mat& grey);

 private:
  BlockMeans blocks_;
  RepeatedImage repeated_;
  Sharpness sharpness_;
};

}  // namespace handeye
