// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/tracking/opencv_flow.hpp"

#include <opencv2/video/tracking.hpp>

namespace handeye::test {
namespace {

const cv::Size kWindow(21, 21);
constexpr int kLevels = 3;
constexpr double kMaxMissPx = 0.5;

}  // namespace

OpenCvFlow::OpenCvFlow(const cv::Mat& first, const std::vector<Eigen::Vector2d>& corners)
    : alive_(corners.size(), 1) {
  cv::buildOpticalFlowPyramid(first, last_, kWindow, kLevels);
  for (const Eigen::Vector2d& corner : corners) {
    pixels_.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
  }
}

void OpenCvFlow::track(const cv::Mat& grey) {
  cv::buildOpticalFlowPyramid(grey, now_, kWindow, kLevels);
  std::vector<std::size_t> corners;
  std::vector<cv::Point2f> from;
  for (std::size_t i = 0; i < alive_.size(); ++i) {
    if (alive_[i] == 0) continue;
    corners.push_back(i);
    from.push_back(pixels_[i]);
  }
  std::vector<cv::Point2f> to;
  std::vector<cv::Point2f> back;
  std::vector<std::uint8_t> found;
  std::vector<std::uint8_t> found_back;
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
  if (!from.empty()) {
    cv::calcOpticalFlowPyrLK(last_, now_, from, to, found, cv::noArray(), kWindow, kLevels,
                             criteria);
    cv::calcOpticalFlowPyrLK(now_, last_, to, back, found_back, cv::noArray(), kWindow, kLevels,
                             criteria);
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const bool home =
        found[k] != 0 && found_back[k] != 0 && cv::norm(back[k] - from[k]) <= kMaxMissPx;
    alive_[corners[k]] = home ? 1 : 0;
    pixels_[corners[k]] = to[k];
  }
  std::swap(last_, now_);
}

}  // namespace handeye::test
