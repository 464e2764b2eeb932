// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace handeye {

/// A feature that the tracker follows; positions at the working size.
struct Feature {
  static constexpr int kNoReference = -1;

  std::int64_t id{0};
  cv::Point2f pixel;
  cv::Point2f velocity;         ///< px per frame, of the last movement
  float strength{0};            ///< as a corner, when it was found
  int reference{kNoReference};  ///< the earlier image that it is compared with
  cv::Point2f reference_pixel;  ///< where it was there
  bool lost{false};
};

}  // namespace handeye
