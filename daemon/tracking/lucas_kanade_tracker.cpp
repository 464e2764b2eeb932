// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "daemon/tracking/lk_corner_grid.hpp"
#include "daemon/tracking/drift_correction.hpp"
#include "daemon/tracking/feature_tracker.hpp"
#include "daemon/tracking/round_trip_flow.hpp"
#include "daemon/tracking/working_image.hpp"

namespace handeye {
namespace {

constexpr int kWindowPx = 21;
constexpr int kShrunkWindowPx = 31;
/// Cells looked at per frame for new features, as a fraction of all: empty cells without texture
/// would otherwise cost a full detection in every frame.
constexpr int kCellsFraction = 6;
/// More cells than features wanted: some are empty of texture, others hold two.
constexpr double kCellsPerFeature = 1.1;

class LucasKanadeTracker final : public FeatureTracker {
 public:
  explicit LucasKanadeTracker(const TrackerOptions& options) : options_(options) {}

  void track(const cv::Mat& grey, const cv::Mat& mask, std::int64_t timestamp_ns,
             TrackedFrame& tracked) override {
    if (!working_) begin(grey.size());
    if (!grid_ || mask_changed(mask)) use_mask(mask);
    working_->prepare(grey);
    const cv::Mat& image = working_->normalised();
    cv::buildOpticalFlowPyramid(image, pyramid_, flow_.window(), options_.pyramid_levels);
    follow();
    drift_correction_.correct(pyramid_, options_.max_forward_backward_px, features_);
    drop_lost();
    top_up();
    drift_correction_.renew(image, features_);
    std::swap(pyramid_, last_pyramid_);
    report(timestamp_ns, tracked);
    ++frames_;
  }

 private:
  void begin(cv::Size size) {
    working_.emplace(size);
    const int automatic_px = working_->is_shrunk() ? kShrunkWindowPx : kWindowPx;
    flow_.set_window(options_.window_px > 0 ? options_.window_px : automatic_px);
  }

  bool mask_changed(const cv::Mat& mask) const {
    if (mask.empty() || mask_.empty()) return mask.empty() != mask_.empty();
    return cv::norm(mask, mask_, cv::NORM_INF) != 0;
  }

  /// The whole patch must lie in the mask: its rim does not move with the scene.
  void use_mask(const cv::Mat& mask) {
    mask.copyTo(mask_);
    usable_.release();
    double usable_share = 1.0;
    if (!mask.empty()) {
      cv::erode(working_->shrink_mask(mask), usable_,
                cv::getStructuringElement(cv::MORPH_RECT, flow_.window()));
      usable_share =
          std::max(0.01, cv::countNonZero(usable_) / static_cast<double>(working_->size().area()));
    }
    grid_.emplace(working_->size(),
                  static_cast<int>(kCellsPerFeature * options_.max_features / usable_share),
                  options_.min_distance_px / working_->scale());
  }

  /// From the last image, starting where constant velocity takes each feature.
  void follow() {
    from_.clear();
    to_.clear();
    for (const Feature& feature : features_) {
      from_.push_back(feature.pixel);
      to_.push_back(feature.pixel + feature.velocity);
    }
    flow_.run(last_pyramid_, pyramid_, options_.pyramid_levels, options_.max_forward_backward_px,
              from_, to_, good_);
    for (std::size_t i = 0; i < features_.size(); ++i) {
      Feature& feature = features_[i];
      feature.lost = good_[i] == 0;
      feature.velocity = to_[i] - from_[i];
      feature.pixel = to_[i];
    }
    drop_lost();
  }

  void drop_lost() {
    std::erase_if(features_, [this](const Feature& feature) {
      return feature.lost || !is_usable(feature.pixel);
    });
  }

  bool is_usable(cv::Point2f pixel) const {
    const cv::Point nearest(cvRound(pixel.x), cvRound(pixel.y));
    if (!cv::Rect({0, 0}, working_->size()).contains(nearest)) return false;
    return usable_.empty() || usable_.at<std::uint8_t>(nearest) != 0;
  }

  void top_up() {
    const int room = options_.max_features - static_cast<int>(features_.size());
    if (room <= 0) return;
    from_.clear();
    float strongest = 0;
    for (const Feature& feature : features_) {
      from_.push_back(feature.pixel);
      strongest = std::max(strongest, feature.strength);
    }
    const bool starving = static_cast<int>(features_.size()) < options_.max_features / 2;
    const int cells = starving ? grid_->cell_count() : grid_->cell_count() / kCellsFraction;
    grid_->detect(working_->normalised(), working_->grey(), usable_, from_, cells, corners_);
    for (const LkCorner& corner : corners_) strongest = std::max(strongest, corner.strength);
    std::erase_if(corners_, [&](const LkCorner& corner) {
      return corner.strength < static_cast<float>(options_.quality) * strongest;
    });
    if (static_cast<int>(corners_.size()) > room) {
      std::stable_sort(corners_.begin(), corners_.end(),
                       [](const LkCorner& a, const LkCorner& b) { return a.strength > b.strength; });
      corners_.resize(static_cast<std::size_t>(room));
    }
    for (const LkCorner& corner : corners_) {
      Feature feature;
      feature.id = next_id_++;
      feature.pixel = corner.pixel;
      feature.strength = corner.strength;
      features_.push_back(feature);
    }
  }

  void report(std::int64_t timestamp_ns, TrackedFrame& tracked) const {
    tracked.timestamp_ns = timestamp_ns;
    tracked.index = frames_;
    tracked.observations.clear();
    for (const Feature& feature : features_) {
      tracked.observations.push_back({feature.id, working_->to_given(feature.pixel)});
    }
  }

  TrackerOptions options_;
  RoundTripFlow flow_;
  DriftCorrection drift_correction_{flow_};
  std::optional<WorkingImage> working_;
  std::optional<LkCornerGrid> grid_;
  cv::Mat mask_;    ///< as last given
  cv::Mat usable_;  ///< the same at the working size, shrunk by half a patch
  std::int64_t frames_{0};
  std::int64_t next_id_{0};
  std::vector<Feature> features_;  ///< ordered by id: survivors keep their order, new ones follow
  std::vector<cv::Mat> pyramid_;
  std::vector<cv::Mat> last_pyramid_;
  // Scratch, kept so that a frame allocates next to nothing.
  std::vector<cv::Point2f> from_, to_;
  std::vector<std::uint8_t> good_;
  std::vector<LkCorner> corners_;
};

}  // namespace

std::unique_ptr<FeatureTracker> make_lucas_kanade_tracker(const TrackerOptions& options) {
  return std::make_unique<LucasKanadeTracker>(options);
}

}  // namespace handeye
