// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/reconstruction.hpp"

namespace handeye::test {

/// A scope in front of a surface, and what a tracker would report of it.
struct SyntheticOptions {
  int frames{200};
  double rate_hz{25};
  double noise_px{0.4};         ///< per axis
  double outlier_tracks{0.05};  ///< share of the features that slide off on their own
  double death_rate{0.01};      ///< features lost per frame
  double relief_mm{8};          ///< half the depth of the surface's waves; 0: a plane
  int max_features{250};
  double instrument_share{0};  ///< of the visible features: on a body that moves by itself
  int blind_frame{-1};         ///< all tracks are lost before this frame
  int blind_frames{0};         ///< and nothing is seen for so many from it on
  bool described{false};       ///< features come with what they look like
  unsigned seed{1};
  std::optional<CameraModel> camera;  ///< nothing: an endoscope's
};

/// room_from_eye at a time [s].
using Motion = std::function<Pose(double)>;

/// Free-hand: turns by up to about 20 degrees, moves by up to 15 mm an axis, around a view of the
/// surface from 80 mm.
Motion free_hand();

/// The same turns about the camera's centre, which stays where it is.
Motion turning_only();

/// Free-hand shifts with hardly a turn: parallel views.
Motion sideways();

/// Towards the surface, 80 mm down to 50 within 2 s, with a slight tremble.
Motion forward();

/// Around a point of the surface, looking at it.
Motion orbit();

/// The free-hand turns with shifts of `share` of the free hand's: nearly pure rotation.
Motion nearly_turning(double share);

struct SyntheticTracks {
  CameraModel camera;
  std::vector<TrackedFrame> frames;
  std::vector<Pose> eye_from_room;  ///< the truth, a frame each
};

SyntheticTracks synthesize(const SyntheticOptions& options, const Motion& motion);

/// How far a reconstruction is from the truth, after the similarity that fits best.
struct AlignmentError {
  double rotation_rms_deg{0};
  double rotation_max_deg{0};
  double centre_rms{0};  ///< camera centres, in units of the truth
  double extent{0};      ///< rms distance of the true centres from their mean
};

/// `truth` is indexed by RegisteredFrame::index.
AlignmentError compare(const std::vector<RegisteredFrame>& frames, const std::vector<Pose>& truth);

}  // namespace handeye::test
