// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "tests/unit/handeye/synthetic.hpp"

/// What a camera sees of a scene with relief: points, and their tracks over the frames.
namespace handeye::synthetic {

struct TrackOptions {
  int frames{130};
  double rate_hz{25};
  int features{45};          ///< live in every frame
  double feature_life_s{2};  ///< mean; each dies at a random time, or leaves the picture
  double noise_px{0.5};      ///< per axis
  /// Time in which a track's error forgets itself (its variance stays that of the noise); 0: at
  /// once.
  double noise_memory_s{0};
  double bad_tracks{0};    ///< share of tracks that are worse,
  double bad_noise_px{3};  ///< by so much, per axis
  int parts{1};            ///< of equal length; no track outlasts its part
  Motion motion{free_hand};
  double from_s{0};  ///< time of the motion at the first frame
};

/// One feature: seen in consecutive frames from `first` on.
struct Track {
  Eigen::Vector3d point_room;  ///< mm
  int part{0};
  int first{0};
  std::vector<Eigen::Vector2d> pixels;  ///< with noise; a frame each

  int end() const { return first + static_cast<int>(pixels.size()); }
};

struct Tracks {
  CameraModel camera;
  std::vector<Pose> eye_from_room;  ///< of each frame
  std::vector<int> part;            ///< of each frame
  std::vector<Track> tracks;
};

CameraModel endoscope_camera();

Tracks tracks(const TrackOptions& options, std::mt19937& generator);

}  // namespace handeye::synthetic
