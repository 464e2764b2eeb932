// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace handeye::test {

/// Where an endoscope's picture is on the sensor.
struct Disc {
  cv::Size size;
  cv::Point centre;
  int radius;
};

/// 255 within the disc.
cv::Mat truth_of(const Disc& disc);

/// Tissue-like brightness over all of the image, with a dark cavity.
cv::Mat tissue(cv::Size size);

/// What an endoscope of this disc shows.
cv::Mat view(const Disc& disc, unsigned seed = 9);

struct Agreement {
  double overlap{0};  ///< intersection over union
  int outside{0};     ///< px found that are not of the truth
};
Agreement compare(const cv::Mat& found, const cv::Mat& truth);

/// What was found has the truth's size, lies within it and overlaps it by more than that.
void expect_within(const cv::Mat& found, const cv::Mat& truth, double overlap);

}  // namespace handeye::test
