// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "daemon/tracking/corner_grid.hpp"
#include "daemon/tracking/feature_tracker.hpp"

namespace handeye {
namespace {

constexpr int kIterations = 30;
constexpr double kConvergencePx = 0.01;
/// Smallest eigenvalue of the patch's normal matrix (OpenCV's measure) that LK accepts.
constexpr double kMinEigenvalue = 1e-4;
/// Cells looked at per frame for new features, as a share: empty cells without texture would
/// otherwise cost a full detection in every frame.
constexpr int kCellsShare = 6;
/// A cell more than features wanted: some are empty of texture, others hold two.
constexpr double kCellsPerFeature = 1.1;
/// The widths up to which the basic window and number of levels are right.
constexpr int kBasicWidth = 1280;

struct Feature {
  std::int64_t id{0};
  cv::Point2f pixel;
  cv::Point2f velocity;  ///< px per frame, of the last movement
  float strength{0};     ///< as a corner, when it was found
};

int odd(double value) {
  return 2 * static_cast<int>(std::lround((value - 1.0) / 2.0)) + 1;
}

TrackerOptions adapted(TrackerOptions options, cv::Size size) {
  const bool large = size.width > kBasicWidth;
  if (options.window_px <= 0) {
    options.window_px = large ? odd(21.0 * size.width / kBasicWidth) : 21;
  }
  if (options.pyramid_levels <= 0) options.pyramid_levels = large ? 5 : 4;
  return options;
}

class LucasKanadeTracker final : public FeatureTracker {
 public:
  explicit LucasKanadeTracker(const TrackerOptions& options) : given_options_(options) {}

  void track(const cv::Mat& grey, const cv::Mat& mask, std::int64_t timestamp_ns,
             TrackedFrame& tracked) override {
    if (!grid_) begin(grey.size());
    update_usable(mask);
    build_pyramid(grey);
    if (frames_ > 0) follow();
    top_up(grey);
    std::swap(pyramid_, last_pyramid_);
    report(timestamp_ns, tracked);
    ++frames_;
  }

 private:
  void begin(cv::Size size) {
    options_ = adapted(given_options_, size);
    grid_.emplace(size, static_cast<int>(kCellsPerFeature * options_.max_features),
                  options_.min_distance_px);
    size_ = size;
  }

  /// The whole patch must lie in the mask: its rim does not move with the scene.
  void update_usable(const cv::Mat& mask) {
    if (mask.empty()) {
      usable_.release();
      mask_.release();
      return;
    }
    if (!mask_.empty() && cv::norm(mask, mask_, cv::NORM_INF) == 0) return;
    mask.copyTo(mask_);
    const cv::Mat patch =
        cv::getStructuringElement(cv::MORPH_RECT, {options_.window_px, options_.window_px});
    cv::erode(mask, usable_, patch);
  }

  void build_pyramid(const cv::Mat& grey) {
    cv::buildOpticalFlowPyramid(grey, pyramid_, window(), options_.pyramid_levels);
  }

  cv::Size window() const { return {options_.window_px, options_.window_px}; }

  /// Forward from where constant velocity takes each feature, then back; who does not come home is
  /// lost.
  void follow() {
    if (features_.empty()) return;
    before_.clear();
    after_.clear();
    for (const Feature& feature : features_) {
      before_.push_back(feature.pixel);
      after_.push_back(feature.pixel + feature.velocity);
    }
    run(last_pyramid_, pyramid_, before_, after_, found_);
    back_.clear();
    for (std::size_t i = 0; i < features_.size(); ++i) {
      back_.push_back(after_[i] - features_[i].velocity);
    }
    run(pyramid_, last_pyramid_, after_, back_, found_back_);
    keep_survivors();
  }

  void run(const std::vector<cv::Mat>& from, const std::vector<cv::Mat>& to,
           const std::vector<cv::Point2f>& start, std::vector<cv::Point2f>& end,
           std::vector<std::uint8_t>& found) {
    cv::calcOpticalFlowPyrLK(
        from, to, start, end, found, errors_, window(), options_.pyramid_levels,
        {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations, kConvergencePx},
        cv::OPTFLOW_USE_INITIAL_FLOW, kMinEigenvalue);
  }

  void keep_survivors() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < features_.size(); ++i) {
      const cv::Point2f missed_home = back_[i] - before_[i];
      const bool good = found_[i] != 0 && found_back_[i] != 0 &&
                        cv::norm(missed_home) <= options_.max_forward_backward_px &&
                        is_usable(after_[i]);
      if (!good) continue;
      Feature feature = features_[i];
      feature.velocity = after_[i] - before_[i];
      feature.pixel = after_[i];
      features_[kept++] = feature;
    }
    features_.resize(kept);
  }

  bool is_usable(cv::Point2f pixel) const {
    const cv::Point nearest(cvRound(pixel.x), cvRound(pixel.y));
    if (!cv::Rect({0, 0}, size_).contains(nearest)) return false;
    return usable_.empty() || usable_.at<std::uint8_t>(nearest) != 0;
  }

  void top_up(const cv::Mat& grey) {
    const int room = options_.max_features - static_cast<int>(features_.size());
    if (room <= 0) return;
    before_.clear();
    float strongest = 0;
    for (const Feature& feature : features_) {
      before_.push_back(feature.pixel);
      strongest = std::max(strongest, feature.strength);
    }
    const bool starving = static_cast<int>(features_.size()) < options_.max_features / 2;
    const int cells = starving ? grid_->cell_count() : grid_->cell_count() / kCellsShare;
    grid_->detect(grey, usable_, before_, cells, corners_);
    for (const Corner& corner : corners_) strongest = std::max(strongest, corner.strength);
    std::erase_if(corners_, [&](const Corner& corner) {
      return corner.strength < static_cast<float>(options_.quality) * strongest;
    });
    if (static_cast<int>(corners_.size()) > room) {
      std::stable_sort(corners_.begin(), corners_.end(),
                       [](const Corner& a, const Corner& b) { return a.strength > b.strength; });
      corners_.resize(static_cast<std::size_t>(room));
    }
    for (const Corner& corner : corners_) {
      features_.push_back({next_id_++, corner.pixel, {0, 0}, corner.strength});
    }
  }

  void report(std::int64_t timestamp_ns, TrackedFrame& tracked) const {
    tracked.timestamp_ns = timestamp_ns;
    tracked.index = frames_;
    tracked.observations.clear();
    for (const Feature& feature : features_) {
      tracked.observations.push_back({feature.id, {feature.pixel.x, feature.pixel.y}});
    }
  }

  TrackerOptions given_options_;
  TrackerOptions options_;
  cv::Size size_;
  std::optional<CornerGrid> grid_;
  cv::Mat mask_;
  cv::Mat usable_;  ///< mask_ shrunk by half a patch
  std::int64_t frames_{0};
  std::int64_t next_id_{0};
  std::vector<Feature> features_;  ///< ordered by id: survivors keep their order, new ones follow
  std::vector<cv::Mat> pyramid_;
  std::vector<cv::Mat> last_pyramid_;
  // Scratch, kept so that a frame allocates nothing.
  std::vector<cv::Point2f> before_, after_, back_;
  std::vector<std::uint8_t> found_, found_back_;
  std::vector<float> errors_;
  std::vector<Corner> corners_;
};

}  // namespace

std::unique_ptr<FeatureTracker> make_lucas_kanade_tracker(const TrackerOptions& options) {
  return std::make_unique<LucasKanadeTracker>(options);
}

}  // namespace handeye
