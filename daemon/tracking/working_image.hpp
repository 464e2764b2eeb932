// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye {

/// What the tracker sees of an image: wide images shrunk to a half, a quarter... of their size, and
/// every image divided by its local mean. The light of an endoscope moves with the camera, so the
/// shading stands still in the image while the scene moves; undivided it drags every feature along,
/// a few hundredths of a pixel a frame, which adds up to pixels.
class WorkingImage {
 public:
  /// Widest image that is worked on at its own size [px].
  static constexpr int kMaxWidth = 1280;

  explicit WorkingImage(cv::Size given);

  cv::Size size() const { return size_; }
  bool is_shrunk() const { return size_ != given_; }

  /// Given px per working px.
  double scale() const { return static_cast<double>(given_.width) / size_.width; }

  /// Takes the next image (CV_8UC1 of the given size).
  void prepare(const cv::Mat& grey);

  /// At the working size as it was given; highlights are still bright in it.
  const cv::Mat& grey() const { return grey_; }

  /// At the working size over the local mean: CV_8UC1, the mean at 128.
  const cv::Mat& normalised() const { return normalised_; }

  /// A mask at the working size.
  cv::Mat shrink_mask(const cv::Mat& mask) const;

  /// A position of the working image in the given one; pixel centres at integers in both.
  Eigen::Vector2d to_given(cv::Point2f pixel) const;

 private:
  void normalise();

  cv::Size given_;
  cv::Size size_;
  cv::Mat grey_;
  cv::Mat mean_;
  cv::Mat normalised_;
};

}  // namespace handeye
