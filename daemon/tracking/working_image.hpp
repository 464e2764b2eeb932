// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye {

/// The size at which the tracker works: that of the images, or a half, a quarter... of it for wide
/// ones.
class WorkingImage {
 public:
  /// Widest image that is worked on as it is [px].
  static constexpr int kMaxWidth = 1280;

  explicit WorkingImage(cv::Size given);

  cv::Size size() const { return size_; }
  bool is_shrunk() const { return size_ != given_; }

  /// Given px per working px.
  double scale() const { return static_cast<double>(given_.width) / size_.width; }

  /// The image at the working size, smoothed where shrunk; the given one itself where not.
  const cv::Mat& shrink(const cv::Mat& grey);

  /// A mask at the working size.
  cv::Mat shrink_mask(const cv::Mat& mask) const;

  /// A position of the working image in the given one; pixel centres at integers in both.
  Eigen::Vector2d to_given(cv::Point2f pixel) const;

 private:
  cv::Size given_;
  cv::Size size_;
  cv::Mat shrunk_;
};

}  // namespace handeye
