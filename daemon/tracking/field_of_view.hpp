// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace handeye {

/// Finds what the optics leave visible of the sensor: an endoscope shows a bright disc on black.
/// Returns CV_8UC1 of the image's size, 255 = usable, already eroded away from the rim; empty when
/// the whole image is usable (an ordinary camera) or the image is too dark to tell.
cv::Mat find_field_of_view(const cv::Mat& grey);

}  // namespace handeye
