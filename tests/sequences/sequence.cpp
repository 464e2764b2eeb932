// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sequences/sequence.hpp"

#include <cmath>

namespace handeye::sequences {
namespace {

/// The start of the host's clock in recordings of `handeye-sim record`, too.
constexpr std::int64_t kStartNs = 1'000'000'000'000;

/// Bilinear; 0 outside and where any of the four has none.
double depth_at(const cv::Mat1f& depth_mm, const Eigen::Vector2d& pixel) {
  const int column = static_cast<int>(std::floor(pixel.x()));
  const int row = static_cast<int>(std::floor(pixel.y()));
  if (column < 0 || row < 0 || column + 1 >= depth_mm.cols || row + 1 >= depth_mm.rows) return 0;
  const double right = pixel.x() - column;
  const double down = pixel.y() - row;
  const double upper_left = static_cast<double>(depth_mm(row, column));
  const double upper_right = static_cast<double>(depth_mm(row, column + 1));
  const double lower_left = static_cast<double>(depth_mm(row + 1, column));
  const double lower_right = static_cast<double>(depth_mm(row + 1, column + 1));
  if (upper_left <= 0 || upper_right <= 0 || lower_left <= 0 || lower_right <= 0) return 0;
  return std::lerp(std::lerp(upper_left, upper_right, right),
                   std::lerp(lower_left, lower_right, right), down);
}

}  // namespace

Sequence::Sequence(std::string_view name, const SequenceOptions& options)
    : world_(simulator_options(name, options), kStartNs),
      view_(world_),
      frames_(static_cast<std::uint32_t>(std::ceil(options.duration_s * options.camera_rate_hz))) {}

bool Sequence::next(SequenceFrame& frame) {
  while (next_number_ < frames_ && view_.fate(next_number_).missing) ++next_number_;
  if (next_number_ == frames_) return false;
  const simulator::FrameFate fate = view_.fate(next_number_);
  const double exposed_s = view_.exposed_s(next_number_);
  frame.number = next_number_;
  frame.timestamp_ns = world_.host_ns(exposed_s + world_.camera_delay_s);
  frame.scene_from_eye = world_.surface_from_eye(exposed_s);
  frame.frozen = fate.frozen(next_number_);
  frame.dark = fate.dark;
  view_.draw(next_number_, frame.grey);
  view_.depth_mm().copyTo(frame.depth_mm);
  ++next_number_;
  return true;
}

Pose Sequence::scene_from_eye(std::int64_t timestamp_ns) const {
  const double stamped_s = 1e-9 * static_cast<double>(timestamp_ns - world_.start_ns);
  return world_.surface_from_eye(stamped_s - world_.camera_delay_s);
}

std::optional<Eigen::Vector2d> true_pixel(const CameraModel& camera, const cv::Mat1f& depth_mm,
                                          const Pose& scene_from_eye, const Eigen::Vector2d& pixel,
                                          const Pose& scene_from_other_eye) {
  const double depth = depth_at(depth_mm, pixel);
  const auto ray = unproject(camera, pixel);
  if (depth <= 0 || !ray) return std::nullopt;
  const Eigen::Vector3d point = scene_from_eye * (depth * ray->homogeneous());
  const Eigen::Vector3d in_other = scene_from_other_eye.inverse() * point;
  if (in_other.z() <= 0) return std::nullopt;
  const Eigen::Vector2d seen = project<double>(camera, in_other);
  const bool inside = seen.x() >= 0 && seen.y() >= 0 && seen.x() <= camera.width - 1 &&
                      seen.y() <= camera.height - 1;
  return inside ? std::optional(seen) : std::nullopt;
}

}  // namespace handeye::sequences
