// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/lens_start.hpp"

#include <algorithm>
#include <array>

#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/lens_fit.hpp"
#include "daemon/reconstruction/lens_scene.hpp"

namespace handeye {
namespace {

/// Horizontal fields of view tried [deg]: each reaches to half way to the next.
constexpr std::array kFieldsDeg{40.0, 55.0, 72.0, 95.0};
constexpr std::array kDistortions{0.0, -0.25};  ///< k1
constexpr int kMaxKeyframes = 20;
/// A lens under which fewer of the frames could be registered is out.
constexpr double kMinRegistered = 0.5;
/// Errors beyond this many px count no more than this.
constexpr double kCap = 2.0;

struct Hypothesis {
  CameraModel camera;
  double error_px{0};
};

/// What becomes of a lens: reconstructs under it, then adjusts it.
std::optional<Hypothesis> carry(const CameraModel& start, std::span<const TrackedFrame> frames,
                                const ReconstructionOptions& options) {
  ReconstructionOptions wide = options;
  wide.max_reprojection_px = 2.0 * options.max_reprojection_px;
  IncrementalReconstruction reconstruction(start, wide);
  for (const TrackedFrame& frame : frames) reconstruction.add(frame);
  const Reconstruction found = reconstruction.current();
  const auto registered = std::ranges::count(found.frames, 0, &RegisteredFrame::part);
  if (static_cast<double>(registered) < kMinRegistered * static_cast<double>(frames.size())) {
    return std::nullopt;
  }
  Hypothesis hypothesis{start};
  Scene scene = scene_of(start, found, frames, kMaxKeyframes, wide);
  if (scene.keyframes.size() < 3 || scene.point_count() < options.min_common_features) {
    return std::nullopt;
  }
  fit_lens(lens_prior(start, IntrinsicsMode::kEstimate), false, options, scene, hypothesis.camera);
  hypothesis.error_px =
      scene_fit(hypothesis.camera, kCap * options.max_reprojection_px, scene).error_px;
  return hypothesis;
}

}  // namespace

std::optional<CameraModel> find_start_lens(int width, int height,
                                           std::span<const TrackedFrame> frames,
                                           const ReconstructionOptions& options) {
  std::optional<Hypothesis> best;
  for (const double field_deg : kFieldsDeg) {
    for (const double k1 : kDistortions) {
      CameraModel start = plain_camera(width, height, rad_from_deg(field_deg));
      start.distortion[0] = k1;
      const auto hypothesis = carry(start, frames, options);
      if (!hypothesis) continue;
      if (!best || hypothesis->error_px < best->error_px) best = hypothesis;
    }
  }
  if (!best) return std::nullopt;
  return best->camera;
}

}  // namespace handeye
