// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

/// The outline of the field of view: of the largest region of `lit` (CV_8UC1, 255 = lit), if it is
/// one: large, compact, mostly along a circle or an upright rectangle (or what both leave of each
/// other), and sharp. `brightness`: the same image in grey, any unit. Empty: the image has no rim.
///
/// Dark cavities within are bridged; the shading of a lens, the edge of the light, things in view
/// have soft or ragged outlines and are none.
std::vector<cv::Point> find_field_outline(const cv::Mat& lit, const cv::Mat1f& brightness);

}  // namespace handeye
