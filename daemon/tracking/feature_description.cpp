// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/feature_description.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace handeye {
namespace {

constexpr int kPatchPx = 31;
constexpr int kHalfPatch = kPatchPx / 2;
/// Every so many frames: a feature that does not live that long need not be found again.
constexpr int kEveryFrames = 8;
/// With so many new features, as at the start and after a loss, sooner.
constexpr std::size_t kManyUndescribed = 60;
constexpr int kSoonFrames = 3;

/// Direction from the patch's middle to its centre of brightness [deg], in 0..360, as ORB has it.
float centroid_angle_deg(const cv::Mat& grey, cv::Point middle) {
  int moment_x = 0;
  int moment_y = 0;
  for (int y = -kHalfPatch; y <= kHalfPatch; ++y) {
    const std::uint8_t* row = grey.ptr<std::uint8_t>(middle.y + y) + middle.x;
    const int reach =
        static_cast<int>(std::sqrt(static_cast<double>(kHalfPatch * kHalfPatch - y * y)));
    int sum = 0;
    for (int x = -reach; x <= reach; ++x) {
      moment_x += x * row[x];
      sum += row[x];
    }
    moment_y += y * sum;
  }
  return cv::fastAtan2(static_cast<float>(moment_y), static_cast<float>(moment_x));
}

bool has_whole_patch(const cv::Mat& grey, cv::Point middle) {
  return middle.x >= kHalfPatch && middle.y >= kHalfPatch && middle.x < grey.cols - kHalfPatch &&
         middle.y < grey.rows - kHalfPatch;
}

}  // namespace

FeatureDescriber::FeatureDescriber()
    : orb_(cv::ORB::create(500, 1.2F, 1, kHalfPatch, 0, 2, cv::ORB::HARRIS_SCORE, kPatchPx)) {}

void FeatureDescriber::describe(const cv::Mat& grey, double scale, TrackedFrame& tracked) {
  tracked.descriptions.clear();
  ++frames_since_;
  if (tracked.observations.empty()) return;
  collect_undescribed(tracked);
  const int wait = undescribed_.size() >= kManyUndescribed ? kSoonFrames : kEveryFrames;
  if (undescribed_.empty() || frames_since_ < wait) return;
  frames_since_ = 0;
  place_keypoints(grey, scale, tracked);
  if (keypoints_.empty()) return;
  orb_->compute(grey, keypoints_, bits_);
  for (std::size_t i = 0; i < keypoints_.size(); ++i) {
    FeatureDescription description;
    const auto position = static_cast<std::size_t>(keypoints_[i].class_id);
    description.feature_id = tracked.observations[position].feature_id;
    std::memcpy(description.bits.data(), bits_.ptr(static_cast<int>(i)), description.bits.size());
    tracked.descriptions.push_back(description);
    described_.push_back(description.feature_id);
  }
  std::sort(described_.begin(), described_.end());
}

void FeatureDescriber::collect_undescribed(const TrackedFrame& tracked) {
  undescribed_.clear();
  still_alive_.clear();
  auto done = described_.begin();
  for (std::size_t i = 0; i < tracked.observations.size(); ++i) {
    const std::int64_t id = tracked.observations[i].feature_id;
    while (done != described_.end() && *done < id) ++done;
    if (done != described_.end() && *done == id) {
      still_alive_.push_back(id);
    } else {
      undescribed_.push_back(i);
    }
  }
  std::swap(described_, still_alive_);
}

/// Features so near the border that their patch is cut off wait until they have moved inwards.
void FeatureDescriber::place_keypoints(const cv::Mat& grey, double scale,
                                       const TrackedFrame& tracked) {
  keypoints_.clear();
  for (const std::size_t position : undescribed_) {
    // Pixel centres lie at integers in both images.
    const Eigen::Vector2d pixel =
        (tracked.observations[position].pixel.array() + 0.5) / scale - 0.5;
    const cv::Point nearest(cvRound(pixel.x()), cvRound(pixel.y()));
    if (!has_whole_patch(grey, nearest)) continue;
    cv::KeyPoint keypoint(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), kPatchPx);
    keypoint.angle = centroid_angle_deg(grey, nearest);
    keypoint.octave = 0;
    keypoint.class_id = static_cast<int>(position);
    keypoints_.push_back(keypoint);
  }
}

}  // namespace handeye
