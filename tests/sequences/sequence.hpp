// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <opencv2/core.hpp>

#include "drivers/simulator/endoscope_view.hpp"
#include "drivers/simulator/world.hpp"
#include "tests/sequences/sequence_kind.hpp"

namespace handeye::sequences {

/// One image of a sequence and the truth behind it.
struct SequenceFrame {
  std::uint32_t number{0};  ///< the camera's count: a gap where frames are missing
  std::int64_t timestamp_ns{0};
  cv::Mat grey;  ///< CV_8UC1
  /// Where the eye truly was; of interlaced images when the even lines were exposed. The picture of
  /// a frozen frame is an earlier one's, the pose is not.
  Pose scene_from_eye{Pose::Identity()};
  bool frozen{false};
  bool dark{false};
  /// z in the eye frame [mm] behind every pixel, 0 where an instrument hides the scene; of no use
  /// where frozen or dark.
  cv::Mat1f depth_mm;
};

/// Streams the frames of a named sequence: free motion by +-20 deg and +-15 mm about a view of
/// tissue from 80 mm, but for what the name says. The same name and options give the same bytes,
/// whatever was asked before; it is `write_sequence`'s recording before JPEG. One thread.
class Sequence {
 public:
  /// Throws UsageError for an unknown name.
  explicit Sequence(std::string_view name, const SequenceOptions& options = {});
  Sequence(const Sequence&) = delete;
  Sequence& operator=(const Sequence&) = delete;

  /// Draws the next frame; false after the last. Its memory is reused when the same object is
  /// passed.
  bool next(SequenceFrame& frame);

  /// Begins again.
  void rewind() { next_number_ = 0; }

  const CameraModel& camera() const { return world_.camera; }

  /// From the eye to what it circles, in the mean: the measure of position errors.
  double scene_distance_mm() const { return simulator::MotionOptions{}.view_distance_mm; }

  /// The true pose at a frame's time stamp (or any other instant).
  Pose scene_from_eye(std::int64_t timestamp_ns) const;

  const simulator::World& world() const { return world_; }

  /// How many frames there would be if none were missing.
  std::uint32_t frames() const { return frames_; }

 private:
  simulator::World world_;
  simulator::EndoscopeView view_;
  std::uint32_t frames_;
  std::uint32_t next_number_{0};
};

/// Where what is seen at a pixel of one frame shows in another: the truth for feature tracks. Depth
/// is interpolated between pixels. Nothing outside the image, behind an instrument (of the first
/// frame), or behind the eye.
std::optional<Eigen::Vector2d> true_pixel(const CameraModel& camera, const cv::Mat1f& depth_mm,
                                          const Pose& scene_from_eye, const Eigen::Vector2d& pixel,
                                          const Pose& scene_from_other_eye);

}  // namespace handeye::sequences
