// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/frame_record.hpp"

namespace handeye {

/// A feature in a keyframe.
struct TrackObservation {
  int keyframe{0};        ///< position in Scene::keyframes
  Eigen::Vector2d pixel;  ///< as seen
  Eigen::Vector2d ray;    ///< undistorted (x/z, y/z)
  bool inlier{true};      ///< agrees with the point; judged anew after each adjustment
};

/// A feature through the keyframes and, once it could be triangulated, its point.
struct Track {
  std::int64_t feature_id{0};
  std::vector<TrackObservation> observations;  ///< ordered by keyframe
  bool has_point{false};
  Eigen::Vector3d point_scene{Eigen::Vector3d::Zero()};  ///< scene units
};

struct Keyframe {
  std::int64_t frame_index{0};  ///< FrameRecord::index
  Pose eye_from_scene{Pose::Identity()};
  double travel_px{0};      ///< image movement summed up to here, at kReferenceFocalPx
  std::vector<int> tracks;  ///< positions in Scene::tracks
};

/// Where a known point was seen.
struct PointMatch {
  Eigen::Vector3d point_scene;
  Eigen::Vector2d pixel;
};

/// Keyframes and tracks of one connected reconstruction.
class Scene {
 public:
  /// Appends a keyframe; its observations extend their tracks or begin new ones.
  void add_keyframe(const CameraModel& camera, const FrameRecord& frame, const Pose& eye_from_scene,
                    double travel_px);

  /// Forgets a keyframe and its observations.
  void remove_keyframe(int keyframe);

  /// Computes all rays anew, for another lens; observations that have none under it are dropped.
  void refresh_rays(const CameraModel& camera);

  /// The features of a frame that have a point.
  void find_matches(const FrameRecord& frame, std::vector<PointMatch>& matches) const;

  int point_count() const;

  std::vector<Keyframe> keyframes;
  std::vector<Track> tracks;

 private:
  std::unordered_map<std::int64_t, int> track_of_feature_;
};

}  // namespace handeye
