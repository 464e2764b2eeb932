// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

#include "daemon/tracking/corner_supply.hpp"
#include "daemon/tracking/feature_description.hpp"
#include "daemon/tracking/feature_tracker.hpp"
#include "daemon/tracking/image_pyramid.hpp"
#include "daemon/tracking/motion_model.hpp"
#include "daemon/tracking/parallel_loop.hpp"
#include "daemon/tracking/track_table.hpp"

namespace handeye {
namespace {

constexpr int kWidestPx = 1280;  ///< wider images are halved
constexpr float kLeastCorrelation = 0.8F;
constexpr float kLargestSigmaPx = 0.3F;
/// An appearance grown or shrunk by more is renewed.
constexpr float kMostGrowth = 1.6F;
/// One that has come to look different by more is renewed while it is still known for sure.
constexpr float kRenewCorrelation = 0.9F;
/// Level of the pyramid at which the search for a feature of known velocity begins.
constexpr int kPredictedLevel = 2;
constexpr double kLongestGapS = 1.0;  ///< a velocity older than that says nothing

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

class IlluminationTracker final : public FeatureTracker {
 public:
  explicit IlluminationTracker(const TrackerOptions& options)
      : options_(options),
        loop_(options.threads),
        tracks_(static_cast<std::size_t>(options.max_features)),
        supply_(options) {}

  void track(const cv::Mat& grey, const cv::Mat& mask, std::int64_t timestamp_ns,
             TrackedFrame& tracked) override {
    take_in(grey, mask);
    predict(timestamp_ns);
    follow();
    model_.fit(from_, coarse_, followed_);
    compare_with_first_appearance();
    look_again_where_lost();
    settle(timestamp_ns);
    renew_appearances();
    top_up();
    report(timestamp_ns, tracked);
    // In the given image, however wide: shrunk, fewer are recognised and more are mistaken.
    describer_.describe(grey, 1.0, tracked);
    std::swap(now_, before_);
  }

 private:
  void take_in(const cv::Mat& grey, const cv::Mat& mask) {
    halvings_ = 0;
    while ((grey.cols >> halvings_) > kWidestPx) ++halvings_;
    now_.build(grey, mask, halvings_, options_.pyramid_levels + 1);
    const auto& lens = options_.lens;
    const bool fits = lens && lens->width == grey.cols && lens->height == grey.rows;
    lens_ = fits ? std::optional(halved(*lens, halvings_)) : std::nullopt;
  }

  /// Where each feature should be: constant velocity, or as the image as a whole moved.
  void predict(std::int64_t timestamp_ns) {
    from_ = tracks_.pixel;
    coarse_.resize(from_.size());
    followed_.resize(from_.size());
    const double elapsed_s = seconds_between(last_ns_, timestamp_ns);
    const bool fresh = frames_ > 0 && elapsed_s > 0 && elapsed_s < kLongestGapS;
    const auto gap_s = static_cast<float>(fresh ? elapsed_s : 0);
    const float gap_frames = fresh && last_gap_s_ > 0 ? gap_s / static_cast<float>(last_gap_s_) : 0;
    for (std::size_t i = 0; i < from_.size(); ++i) {
      const Eigen::Vector2f own = gap_s * tracks_.velocity[i];
      const Eigen::Vector2f common = gap_frames * (model_.moved(from_[i]) - from_[i]);
      const bool reliable = tracks_.age[i] > 0;
      coarse_[i] = from_[i] + (reliable ? own : common);
    }
  }

  /// Coarse to fine from the last image, shifts only: to half a pixel or so.
  void follow() {
    loop_.run(from_.size(), [this](std::size_t i) {
      const int top = tracks_.age[i] > 0 ? kPredictedLevel : now_.levels() - 1;
      followed_[i] = follow(from_[i], top, coarse_[i]);
    });
  }

  bool follow(const Eigen::Vector2f& from, int top_level, Eigen::Vector2f& to) const {
    bool found = false;
    for (int level = std::min(top_level, now_.levels() - 1); level >= 1; --level) {
      const float scale = 1.0F / static_cast<float>(1 << level);
      Eigen::Vector2f at_level = scale * to;
      const PatchFit fit = align_shift(before_, now_, level, scale * from, at_level);
      found = fit.found;
      if (found) to = at_level / scale;
    }
    return found;
  }

  void compare_with_first_appearance() {
    loop_.run(from_.size(), [this](std::size_t i) { compare(i, coarse_[i]); });
  }

  void compare(std::size_t i, const Eigen::Vector2f& start) {
    AffineWarp warp = tracks_.warp[i];
    warp.centre += start - from_[i];
    if (model_.known()) warp.linear = model_.linear() * warp.linear;
    const PatchFit fit = tracks_.appearance_of(i).align(now_, warp);
    const bool good = fit.found && fit.correlation > kLeastCorrelation &&
                      fit.sigma_px < kLargestSigmaPx && is_usable(warp * tracks_.anchor[i]);
    tracks_.lost[i] = good ? 0 : 1;
    if (!good) return;
    tracks_.warp[i] = warp;
    tracks_.fit[i] = fit;
    tracks_.pixel[i] = warp * tracks_.anchor[i] - bend(i, warp);
  }

  Eigen::Vector2f bend(std::size_t i, const AffineWarp& warp) const {
    if (!tracks_.rays[i]) return Eigen::Vector2f::Zero();
    return bend_px(*lens_, *tracks_.rays[i], warp).cast<float>();
  }

  bool is_usable(const Eigen::Vector2f& pixel) const {
    const auto x = static_cast<int>(std::lround(pixel.x()));
    const auto y = static_cast<int>(std::lround(pixel.y()));
    return now_.all_usable(0, x, y, x, y);
  }

  /// Once more from where the others went.
  void look_again_where_lost() {
    for (std::size_t i = 0; i < from_.size(); ++i) followed_[i] = tracks_.lost[i] == 0;
    model_.fit(from_, tracks_.pixel, followed_);
    if (!model_.known()) return;
    loop_.run(from_.size(), [this](std::size_t i) {
      if (tracks_.lost[i] == 0) return;
      Eigen::Vector2f start = model_.moved(from_[i]);
      follow(from_[i], now_.levels() - 1, start);
      compare(i, start);
    });
  }

  void settle(std::int64_t timestamp_ns) {
    const double elapsed_s = seconds_between(last_ns_, timestamp_ns);
    for (std::size_t i = 0; i < from_.size(); ++i) {
      ++tracks_.age[i];
      if (elapsed_s > 0) {
        tracks_.velocity[i] = (tracks_.pixel[i] - from_[i]) / static_cast<float>(elapsed_s);
      }
    }
    tracks_.drop_lost();
    last_gap_s_ = elapsed_s;
    last_ns_ = timestamp_ns;
  }

  void renew_appearances() {
    loop_.run(tracks_.size(), [this](std::size_t i) {
      const AffineWarp& warp = tracks_.warp[i];
      const float growth = std::sqrt(std::abs(warp.linear.determinant()));
      const bool outgrown = growth > kMostGrowth || growth < 1.0F / kMostGrowth ||
                            tracks_.fit[i].correlation < kRenewCorrelation;
      if (outgrown) take_appearance(i);
    });
  }

  bool take_appearance(std::size_t i) {
    const auto x = static_cast<int>(std::lround(tracks_.pixel[i].x()));
    const auto y = static_cast<int>(std::lround(tracks_.pixel[i].y()));
    constexpr int kReach = Patch::kRadius + 1;
    if (!now_.all_usable(0, x - kReach, y - kReach, x + kReach, y + kReach)) return false;
    if (!tracks_.appearance_of(i).take(now_, x, y)) {
      tracks_.lost[i] = 1;
      return false;
    }
    tracks_.warp[i] = {{static_cast<float>(x), static_cast<float>(y)}, Eigen::Matrix2f::Identity()};
    tracks_.anchor[i] = tracks_.pixel[i] - tracks_.warp[i].centre;
    if (lens_) tracks_.rays[i] = window_rays(*lens_, tracks_.warp[i].centre.cast<double>());
    return true;
  }

  void top_up() {
    tracks_.drop_lost();
    const std::vector<Corner>& corners = supply_.find(now_, halvings_, tracks_);
    for (const Corner& corner : corners) {
      tracks_.add(next_id_++, {static_cast<float>(corner.x), static_cast<float>(corner.y)},
                  corner.strength);
    }
    const std::size_t first = tracks_.size() - corners.size();
    loop_.run(corners.size(), [&](std::size_t i) { take_appearance(first + i); });
    tracks_.drop_lost();
  }

  void report(std::int64_t timestamp_ns, TrackedFrame& tracked) {
    tracked.timestamp_ns = timestamp_ns;
    tracked.index = frames_++;
    tracked.observations.clear();
    const double scale = 1 << halvings_;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      const Eigen::Vector2d pixel = scale * (tracks_.pixel[i].cast<double>().array() + 0.5) - 0.5;
      tracked.observations.push_back({tracks_.id[i], pixel});
    }
  }

  TrackerOptions options_;
  ParallelLoop loop_;
  TrackTable tracks_;
  ImagePyramid now_, before_;
  MotionModel model_;
  CornerSupply supply_;
  FeatureDescriber describer_;
  int halvings_{0};
  std::optional<CameraModel> lens_;  ///< of the working size
  std::int64_t frames_{0};
  std::int64_t next_id_{0};
  std::int64_t last_ns_{0};
  double last_gap_s_{0};
  // Of the frame at hand, a row for a row of the table.
  std::vector<Eigen::Vector2f> from_;    ///< where the feature was in the last image
  std::vector<Eigen::Vector2f> coarse_;  ///< where it should be, then where it roughly is
  std::vector<std::uint8_t> followed_;
};

}  // namespace

std::unique_ptr<FeatureTracker> make_feature_tracker(const TrackerOptions& options) {
  const bool sound = options.max_features >= 1 && options.pyramid_levels >= 1 &&
                     options.pyramid_levels < ImagePyramid::kMaxLevels &&
                     options.min_distance_px >= 0 && options.quality >= 0 && options.threads >= 1;
  if (!sound) {
    throw std::invalid_argument(
        "tracker options: 1 feature or more, 1 to 5 pyramid levels, 1 thread or more, no negative "
        "distance or quality");
  }
  return std::make_unique<IlluminationTracker>(options);
}

}  // namespace handeye
