// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/frame_record.hpp"

namespace handeye {

class Appearances;

/// A feature in a keyframe.
struct TrackObservation {
  int keyframe{0};        ///< position in Scene::keyframes
  Eigen::Vector2d pixel;  ///< as seen
  Eigen::Vector2d ray;    ///< undistorted (x/z, y/z)
  bool inlier{true};      ///< agrees with the point; judged anew after each adjustment
};

/// What a feature looks like: FeatureDescription::bits.
using AppearanceBits = std::array<std::uint8_t, 32>;

/// A feature through the keyframes and, once it could be triangulated, its point. When a feature is
/// recognised as one that had been lost, both share one track.
struct Track {
  std::int64_t feature_id{0};                  ///< the first, if there are several
  std::vector<TrackObservation> observations;  ///< ordered by keyframe
  bool has_point{false};
  Eigen::Vector3d point_scene{Eigen::Vector3d::Zero()};  ///< scene units
  int trust{0};         ///< from agreeing and disagreeing with the frames; see point_trust.hpp
  bool refused{false};  ///< disagreed too often: it is not of this scene and wins no more points
  std::optional<AppearanceBits> appearance;
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
  double weight{1.0};  ///< by how far the point is trusted, in (0, 1]
  int track{-1};       ///< position in Scene::tracks
};

/// Keyframes and tracks of one connected reconstruction.
class Scene {
 public:
  /// Appends a keyframe; its observations extend their tracks or begin new ones.
  void add_keyframe(const CameraModel& camera, const FrameRecord& frame, const Pose& eye_from_scene,
                    double travel_px);

  /// Forgets a keyframe, its observations, and the tracks that keep none.
  void remove_keyframe(int keyframe);

  /// From here on the feature belongs to that track; what its own had gathered goes there too. Not
  /// possible (and nothing happens) where both were seen in the same keyframe.
  bool link(std::int64_t feature_id, int track);

  /// Position of the feature's track, or -1.
  int track_of(std::int64_t feature_id) const;

  /// Computes all rays anew, for another lens; observations that have none under it are dropped.
  void refresh_rays(const CameraModel& camera);

  /// Notes what the features of a keyframe look like, where that is known and was not yet.
  void note_appearances(int keyframe, const Appearances& appearances);

  /// The features of a frame that have a point.
  void find_matches(const FrameRecord& frame, std::vector<PointMatch>& matches) const;

  int point_count() const;

  std::vector<Keyframe> keyframes;
  std::vector<Track> tracks;

 private:
  void drop_empty_tracks();

  std::unordered_map<std::int64_t, int> track_of_feature_;
};

}  // namespace handeye
