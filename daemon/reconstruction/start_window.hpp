// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/scene.hpp"
#include "daemon/reconstruction/two_view.hpp"

namespace handeye {

/// Frames from the first to the last of a stretch and the features that all of them show.
struct StartWindow {
  std::vector<const FrameRecord*> frames;  ///< in order of time, spread evenly over the movement
  std::vector<std::int64_t> features;      ///< ascending
  Eigen::MatrixXd pixels;  ///< 2F x P: rows x and y of a frame [px], columns as `features`
  Eigen::MatrixXd rays;    ///< 2F x P: rows x/z and y/z of a frame, undistorted

  Eigen::Index frame_count() const { return rays.rows() / 2; }
  Eigen::Index feature_count() const { return rays.cols(); }

  /// The features' rays in the first and in another frame.
  std::vector<RayPair> pairs_with_first(Eigen::Index frame) const;

  /// Where a frame shows those of the features that have a point (`points`: as `features`).
  void find_matches(Eigen::Index frame, const std::vector<std::optional<Eigen::Vector3d>>& points,
                    std::vector<PointMatch>& matches) const;

  /// A frame with at most `most` of the features, evenly picked.
  FrameRecord thinned(Eigen::Index frame, Eigen::Index most) const;
};

/// At most `frame_count` of the frames, the first and the last among them, those between where the
/// picture has moved on. Frames between that miss more than a few of the features common to first
/// and last are passed over. The window refers to `frames`.
StartWindow make_start_window(const CameraModel& camera, std::span<const FrameRecord> frames,
                              int frame_count);

}  // namespace handeye
