// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "daemon/tracking/feature.hpp"
#include "daemon/tracking/round_trip_flow.hpp"

namespace handeye {

/// From frame to frame, small errors add up. So each feature is also compared with an image that it
/// was seen in earlier: what remains is one comparison's error, however long it lives. The earlier
/// image is first warped by the homography that takes its features to where they are now; compared
/// unwarped, a patch that has turned or grown since is misplaced by more than it would have
/// drifted.
class DriftCorrection {
 public:
  explicit DriftCorrection(RoundTripFlow& flow) : flow_(flow) {}

  /// Corrects the features that refer to one of the earlier images; each call takes the next image
  /// in use, so that a frame pays for one warp. Marks as lost those that have slid away; those that
  /// look different by now lose their reference. `pyramid` is of the present image.
  void correct(const std::vector<cv::Mat>& pyramid, double max_miss_px,
               std::vector<Feature>& features);

  /// When many features lack a reference, the present image becomes theirs, in place of the oldest.
  void renew(const cv::Mat& image, std::vector<Feature>& features);

 private:
  static constexpr int kReferences = 3;

  int next_in_use(const std::vector<Feature>& features);
  bool warp(const cv::Mat& reference);

  RoundTripFlow& flow_;
  std::array<cv::Mat, kReferences> references_;
  int last_corrected_{kReferences - 1};
  int next_to_replace_{0};
  // Scratch.
  cv::Mat warped_;
  std::vector<cv::Mat> warped_pyramid_;
  std::vector<std::size_t> members_;
  std::vector<cv::Point2f> from_, to_, warped_from_;
  std::vector<std::uint8_t> good_;
};

}  // namespace handeye
