// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace handeye {

/// How sharp an image is beside those before it: motion or a lens out of focus takes away the
/// differences between neighbouring blocks, across the movement or all over.
class Sharpness {
 public:
  /// Of the next image's BlockMeans: about 1 as the others, 0 nothing but blur. An image without
  /// texture is no sharper. The first is 1.
  double beside_recent(const cv::Mat1b& means);

 private:
  struct Detail {
    double across{0};  ///< differences along the rows, relative to the brightness
    double down{0};
  };
  static Detail measure(const cv::Mat1b& means);

  Detail recent_;  ///< the better of the recent ones
};

}  // namespace handeye
