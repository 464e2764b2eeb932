// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "daemon/tracking/feature_tracker.hpp"

namespace handeye {

/// Describes each tracked feature once in its life, by ORB (Rublee et al. 2011: BRIEF turned to the
/// patch's centroid), so that its point can be recognised after its track was lost. Works now and
/// then on all features that have none yet, since most of the cost is smoothing the image: well
/// under a millisecond a frame on average. Deterministic. One thread.
class FeatureDescriber {
 public:
  FeatureDescriber();

  /// To be called for every frame, after its observations are known; fills `tracked.descriptions`.
  /// `grey`: CV_8UC1, the image given to the tracker, or that image shrunk evenly, in which case
  /// `scale` is how many px of the given one make one of it.
  void describe(const cv::Mat& grey, double scale, TrackedFrame& tracked);

 private:
  void collect_undescribed(const TrackedFrame& tracked);
  void place_keypoints(const cv::Mat& grey, double scale, const TrackedFrame& tracked);

  cv::Ptr<cv::ORB> orb_;
  int frames_since_{0};
  std::vector<std::int64_t> described_;  ///< alive at the last frame and done; in order
  std::vector<std::int64_t> still_alive_;
  std::vector<std::size_t> undescribed_;  ///< positions in the frame's observations
  std::vector<cv::KeyPoint> keypoints_;
  cv::Mat bits_;
};

}  // namespace handeye
