// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/round_trip_flow.hpp"

#include <opencv2/video/tracking.hpp>

namespace handeye {
namespace {

constexpr int kIterations = 30;
constexpr double kConvergencePx = 0.01;
/// Smallest eigenvalue of a patch's normal matrix (OpenCV's measure) that can be located: below it,
/// grain holds the patch as firmly as the texture moves it.
constexpr double kMinEigenvalue = 4e-4;

}  // namespace

void RoundTripFlow::run(const std::vector<cv::Mat>& from, const std::vector<cv::Mat>& to,
                        int levels, double max_miss_px, const std::vector<cv::Point2f>& pixels,
                        std::vector<cv::Point2f>& found_pixels, std::vector<std::uint8_t>& good) {
  good.clear();
  if (pixels.empty()) return;
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations,
                                  kConvergencePx);
  back_ = found_pixels;
  cv::calcOpticalFlowPyrLK(from, to, pixels, found_pixels, good, errors_, window_, levels, criteria,
                           cv::OPTFLOW_USE_INITIAL_FLOW, kMinEigenvalue);
  // Back from as far off as the way there began: a start at the origin itself would prove little.
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    back_[i] = found_pixels[i] - (back_[i] - pixels[i]);
  }
  cv::calcOpticalFlowPyrLK(to, from, found_pixels, back_, found_back_, errors_, window_, levels,
                           criteria, cv::OPTFLOW_USE_INITIAL_FLOW, kMinEigenvalue);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (found_back_[i] == 0 || cv::norm(back_[i] - pixels[i]) > max_miss_px) good[i] = 0;
  }
}

}  // namespace handeye
