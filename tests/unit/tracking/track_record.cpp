// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/tracking/track_record.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "daemon/tracking/feature_tracker.hpp"
#include "tests/unit/tracking/opencv_flow.hpp"

namespace handeye::test {
namespace {

constexpr std::int64_t kFrameNs = 40'000'000;
constexpr double kBorderPx = 12.0;

struct Errors {
  std::vector<double> px;
  int kept{0};

  TrackRecord record(std::size_t corners) {
    TrackRecord record{static_cast<int>(corners), kept, 0, 0};
    if (px.empty()) return record;
    double squares = 0;
    for (const double error : px) squares += error * error;
    record.rms_px = std::sqrt(squares / static_cast<double>(px.size()));
    const auto middle = px.begin() + static_cast<std::ptrdiff_t>(px.size() / 2);
    std::nth_element(px.begin(), middle, px.end());
    record.median_px = *middle;
    return record;
  }
};

/// The pixels of the corners that stay in the image in every frame, in order.
std::vector<Observation> staying(const std::vector<Observation>& corners,
                                 const KnownMotion& motion) {
  std::vector<Observation> stay;
  const cv::Rect2d inside(kBorderPx, kBorderPx, motion.size.width - 2 * kBorderPx,
                          motion.size.height - 2 * kBorderPx);
  for (const Observation& corner : corners) {
    bool stays = true;
    for (int frame = 0; stays && frame < motion.frames; ++frame) {
      const auto truth = motion.truth(corner.pixel, frame);
      stays = truth && inside.contains(cv::Point2d(truth->x(), truth->y()));
    }
    if (stays) stay.push_back(corner);
  }
  return stay;
}

}  // namespace

Comparison compare_with_opencv(const KnownMotion& motion) {
  const auto tracker = make_feature_tracker();
  TrackedFrame tracked;
  const cv::Mat first = motion.image(0);
  tracker->track(first, {}, 0, tracked);
  const std::vector<Observation> corners = staying(tracked.observations, motion);
  std::vector<Eigen::Vector2d> pixels;
  for (const Observation& corner : corners) pixels.push_back(corner.pixel);
  OpenCvFlow flow(first, pixels);

  Errors ours;
  Errors opencv;
  for (int frame = 1; frame < motion.frames; ++frame) {
    const cv::Mat image = motion.image(frame);
    tracker->track(image, {}, frame * kFrameNs, tracked);
    flow.track(image);
    ours.kept = opencv.kept = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d truth = *motion.truth(corners[i].pixel, frame);
      const auto seen = std::lower_bound(
          tracked.observations.begin(), tracked.observations.end(), corners[i].feature_id,
          [](const Observation& one, std::int64_t id) { return one.feature_id < id; });
      if (seen != tracked.observations.end() && seen->feature_id == corners[i].feature_id) {
        ++ours.kept;
        ours.px.push_back((seen->pixel - truth).norm());
      }
      if (flow.alive(i)) {
        ++opencv.kept;
        opencv.px.push_back((flow.pixel(i) - truth).norm());
      }
    }
  }
  return {ours.record(corners.size()), opencv.record(corners.size())};
}

}  // namespace handeye::test
