// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/intrinsics_mode.hpp"
#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/tracking/feature_tracker.hpp"

namespace handeye {

struct ReconstructionOptions {
  int min_common_features{25};  ///< between the two views that start it
  double min_start_parallax_px{
      20};  ///< median, after derotation, between those views (at 600 px focal length)
  double max_reprojection_px{2.0};  ///< a point or an observation beyond it is an outlier
  double min_triangulation_deg{2.0};
  int min_resection_inliers{15};
  double min_resection_ratio{0.3};  ///< inliers among the points a frame sees
  double keyframe_parallax_px{
      24};                 ///< median movement since the last keyframe that makes a new one
  int max_keyframes{100};  ///< of a part; beyond it they are thinned evenly
  int local_window{8};     ///< keyframes adjusted when one is added
  double robust_px{1.5};   ///< Huber loss of the adjustments
  int threads{1};          ///< Ceres with two is not reproducible
  bool background{true};   ///< local adjustments on a thread of their own; changes nothing but time
  /// Of a part; beyond it older frames keep their pose relative to their neighbours, but not what
  /// they showed: 10 MB for 300 features.
  int max_observed_frames{2000};
  int min_part_frames{15};     ///< parts with fewer are not worth keeping,
  double min_part_ratio{0.2};  ///< nor with less than this share of the largest one's frames
};

/// A frame whose camera pose is known.
struct RegisteredFrame {
  std::int64_t index{0};  ///< TrackedFrame::index
  std::int64_t timestamp_ns{0};
  Pose eye_from_scene{Pose::Identity()};  ///< translation in scene units, of its part
  bool keyframe{false};
  double reprojection_px{0};  ///< rms over its inlier observations
  int inliers{0};
  int part{0};  ///< frames of one part share scene and scale; 0 has the most frames
  /// Of (w [rad], dt [scene units]) of eye_from_scene, R = Exp(w) R, t = t + dt, at an image noise
  /// of 1 px, the points as they are: inverse information of the inlier observations when the frame
  /// was last registered, each weighed by how far its point is trusted (0.1 to 1). Of a
  /// keyframe, which the adjustment placed, it says what its own image alone would. Zero: nothing
  /// is known, for it was placed by its neighbours.
  Matrix6d unit_covariance{Matrix6d::Zero()};
};

/// A point of a scene and where the keyframes saw it.
struct ScenePoint {
  struct Observation {
    int frame{0};  ///< position in Reconstruction::frames; a keyframe
    Eigen::Vector2d pixel;
  };
  int part{0};
  Eigen::Vector3d point_scene{Eigen::Vector3d::Zero()};  ///< scene units
  std::vector<Observation> observations;                 ///< the inliers, ordered by frame
};

/// Why there is no reconstruction (yet).
enum class ReconstructionState {
  kTooFewFeatures,  ///< tracks are too few or too short to say anything
  kNoMotion,        ///< the image does not move
  kNoParallax,      ///< it moves, but as under pure rotation: no depth
  kTracking,        ///< started; frames are being registered
};

/// Standard deviations of a lens that was adjusted.
struct LensSigma {
  double focal_px{0};
  double centre_px{0};  ///< the larger of cx and cy
  double k1{0}, k2{0};
  double distortion_px{0};  ///< of where the lens takes a ray, the largest where features were seen
};

/// The lens as it came out of a reconstruction.
struct Lens {
  CameraModel camera;
  IntrinsicsMode mode{IntrinsicsMode::kFixed};
  bool observable{true};  ///< false: the images do not tell; the camera must not be believed
  LensSigma sigma;        ///< all 0 where it was fixed
  LensPrior prior;        ///< what was believed before the images; meaningless where it was fixed
  /// For each principal direction of its uncertainty: the keyframes of part 0 as they would be were
  /// the lens off by one standard deviation that way. Empty where it was fixed.
  std::vector<std::vector<RegisteredFrame>> shifted_keyframes;
};

struct Reconstruction {
  ReconstructionState state{ReconstructionState::kTooFewFeatures};
  std::vector<RegisteredFrame> frames;  ///< of all parts worth keeping, in order of time
  int parts{0};
  std::vector<ScenePoint> structure;  ///< the points of those parts
  int points{0};
  double reprojection_px{0};  ///< rms over all inlier observations of those parts
  Lens lens;
};

/// Camera motion and scene up to one similarity from feature tracks, frame by frame: a start by
/// factorisation or two views, resection in which points count by their history, triangulation,
/// local bundle adjustment on a thread of its own; `finish` adjusts everything. After a loss of
/// tracking the frames are looked for in the scene by what the features look like, and the
/// reconstruction goes on when that succeeds; until then a new part is tried, with a scale of its
/// own. Dark and frozen frames are passed over: features that outlast them go on.
/// Deterministic, whatever the threads do. To be used from one thread.
class IncrementalReconstruction {
 public:
  IncrementalReconstruction(const CameraModel& camera, const ReconstructionOptions& options = {});
  ~IncrementalReconstruction();
  IncrementalReconstruction(const IncrementalReconstruction&) = delete;
  IncrementalReconstruction& operator=(const IncrementalReconstruction&) = delete;

  /// Takes the next frame; milliseconds for most, a local adjustment for keyframes.
  ReconstructionState add(const TrackedFrame& frame);

  /// The reconstruction as it stands, every frame that could be registered (keyframes or not).
  /// Cheap: no adjustment.
  Reconstruction current() const;

  /// Adjusts all keyframes and points, registers the other frames again, returns all.
  /// May be called more than once, and frames may be added after it.
  Reconstruction finish();

  /// Another lens from here on, whose image has the same size: the rays kept in the scenes are
  /// computed anew; poses and points stay until the next adjustment, or `finish`, moves them. Meant
  /// for small changes: after large ones it is better to begin again with all frames.
  void set_camera(const CameraModel& camera);

  /// Keyframes so far, over all parts.
  int keyframes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace handeye
