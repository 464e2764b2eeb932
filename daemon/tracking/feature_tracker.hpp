// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/tracking/image_condition.hpp"

namespace handeye {

/// One feature in one image.
struct Observation {
  std::int64_t feature_id{0};  ///< unique for the tracker's life; a lost feature never returns
  Eigen::Vector2d pixel{Eigen::Vector2d::Zero()};  ///< px, pixel centres at integers
};

/// What a feature looks like, to be found again after its track was lost.
struct FeatureDescription {
  std::int64_t feature_id{0};
  std::array<std::uint8_t, 32> bits{};  ///< oriented BRIEF; compared by Hamming distance
};

/// What was tracked into one image, ordered by feature_id.
struct TrackedFrame {
  std::int64_t timestamp_ns{0};  ///< camera stamp of the image
  std::int64_t index{0};         ///< counts the images from 0, also those without observations
  ImageCondition condition{ImageCondition::kGood};  ///< dark, frozen: there are no observations
  std::vector<Observation> observations;
  /// Of features that had none yet, each once in its life, soon after its first appearance.
  std::vector<FeatureDescription> descriptions;
};

/// Images wider than 1280 px are worked on at half their size or less: the optics of an endoscope
/// resolve no more than that, and the grain of camera and video coder, which stands still while the
/// scene moves, holds features back.
struct TrackerOptions {
  int max_features{300};       ///< at least 1
  int pyramid_levels{4};       ///< beyond the working image itself, 1 to 5
  double min_distance_px{10};  ///< between features when new ones are sought, in the given image
  double quality{0.01};        ///< weakest corner accepted, of the strongest in the image
  int threads{2};              ///< to track with, at least 1; the results do not depend on it
  /// Of the given images, where it is known: its bending of the windows is then counted
  /// (bent_window.hpp). One of another size is not used.
  std::optional<CameraModel> lens{};
};

/// Follows features from frame to frame. One thread; frames in order of time.
class FeatureTracker {
 public:
  FeatureTracker() = default;
  FeatureTracker(const FeatureTracker&) = delete;
  FeatureTracker& operator=(const FeatureTracker&) = delete;
  virtual ~FeatureTracker() = default;

  /// Tracks into the next image (CV_8UC1, always one size) and tops up with new features.
  /// `mask`: CV_8UC1 of the image's size, 255 = usable, or empty for the whole image.
  virtual void track(const cv::Mat& grey, const cv::Mat& mask, std::int64_t timestamp_ns,
                     TrackedFrame& tracked) = 0;
};

/// Inverse-compositional tracking with gain, offset and slope of the light per patch (Zinsser,
/// Graessl, Niemann 2004), each feature against its first appearance. Throws std::invalid_argument
/// when an option is out of its range.
std::unique_ptr<FeatureTracker> make_feature_tracker(const TrackerOptions& options = {});

}  // namespace handeye
