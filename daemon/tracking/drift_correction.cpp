// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/drift_correction.hpp"

#include <algorithm>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace handeye {
namespace {

constexpr int kLevels = 1;              ///< of the pyramid: the start is near
constexpr std::size_t kFewest = 12;     ///< features that determine a homography well
constexpr double kMaxCorrectionPx = 3;  ///< a feature farther off than that has slid away
constexpr double kOrphanShare = 0.1;    ///< features without reference that are worth a new one

}  // namespace

void DriftCorrection::correct(const std::vector<cv::Mat>& pyramid, double max_miss_px,
                              std::vector<Feature>& features) {
  const int reference = next_in_use(features);
  if (reference == Feature::kNoReference) return;
  members_.clear();
  from_.clear();
  to_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (features[i].reference != reference) continue;
    members_.push_back(i);
    from_.push_back(features[i].reference_pixel);
    to_.push_back(features[i].pixel);
  }
  if (!warp(references_[static_cast<std::size_t>(reference)])) {
    for (const std::size_t i : members_) features[i].reference = Feature::kNoReference;
    return;
  }
  flow_.run(warped_pyramid_, pyramid, kLevels, max_miss_px, warped_from_, to_, good_);
  for (std::size_t k = 0; k < members_.size(); ++k) {
    Feature& feature = features[members_[k]];
    if (good_[k] == 0) {
      feature.reference = Feature::kNoReference;
      continue;
    }
    feature.lost = cv::norm(to_[k] - feature.pixel) > kMaxCorrectionPx;
    feature.pixel = to_[k];
  }
}

/// The reference whose turn it is, among those that features refer to.
int DriftCorrection::next_in_use(const std::vector<Feature>& features) {
  for (int step = 1; step <= kReferences; ++step) {
    const int reference = (last_corrected_ + step) % kReferences;
    const bool in_use = std::any_of(features.begin(), features.end(), [&](const Feature& feature) {
      return feature.reference == reference;
    });
    if (!in_use) continue;
    last_corrected_ = reference;
    return reference;
  }
  return Feature::kNoReference;
}

bool DriftCorrection::warp(const cv::Mat& reference) {
  if (members_.size() < kFewest) return false;
  const cv::Mat present_from_reference = cv::findHomography(from_, to_);
  if (present_from_reference.empty()) return false;
  cv::warpPerspective(reference, warped_, present_from_reference, reference.size(),
                      cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::perspectiveTransform(from_, warped_from_, present_from_reference);
  cv::buildOpticalFlowPyramid(warped_, warped_pyramid_, flow_.window(), kLevels);
  return true;
}

void DriftCorrection::renew(const cv::Mat& image, std::vector<Feature>& features) {
  const auto orphans = std::count_if(features.begin(), features.end(), [](const Feature& feature) {
    return feature.reference == Feature::kNoReference;
  });
  if (static_cast<double>(orphans) <= kOrphanShare * static_cast<double>(features.size())) return;
  image.copyTo(references_[static_cast<std::size_t>(next_to_replace_)]);
  for (Feature& feature : features) {
    const bool takes_it =
        feature.reference == Feature::kNoReference || feature.reference == next_to_replace_;
    if (!takes_it) continue;
    feature.reference = next_to_replace_;
    feature.reference_pixel = feature.pixel;
  }
  next_to_replace_ = (next_to_replace_ + 1) % kReferences;
}

}  // namespace handeye
