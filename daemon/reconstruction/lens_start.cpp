// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/lens_start.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <future>
#include <vector>

#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/lens_fit.hpp"
#include "daemon/reconstruction/lens_scene.hpp"

namespace handeye {
namespace {

/// Horizontal fields of view tried [deg]: each reaches to half way to the next.
constexpr std::array kFieldsDeg{40.0, 55.0, 72.0, 95.0};
constexpr std::array kDistortions{0.0, -0.25};  ///< k1
constexpr int kMaxKeyframes = 20;
/// Features last for seconds: so many frames show as much of a lens as all that lie between them.
constexpr std::size_t kMaxFrames = 60;
/// A lens under which fewer of the frames could be registered is out.
constexpr double kMinRegistered = 0.5;
/// Errors beyond this many px count no more than this.
constexpr double kCap = 2.0;

struct Hypothesis {
  CameraModel camera;
  double error_px{0};
};

std::vector<TrackedFrame> thinned(std::span<const TrackedFrame> frames) {
  if (frames.size() <= kMaxFrames) return {frames.begin(), frames.end()};
  std::vector<TrackedFrame> kept;
  for (std::size_t i = 0; i < kMaxFrames; ++i) {
    kept.push_back(frames[i * frames.size() / kMaxFrames]);
  }
  return kept;
}

std::vector<CameraModel> lenses_to_try(int width, int height) {
  std::vector<CameraModel> lenses;
  for (const double field_deg : kFieldsDeg) {
    for (const double k1 : kDistortions) {
      lenses.push_back(plain_camera(width, height, rad_from_deg(field_deg)));
      lenses.back().distortion[0] = k1;
    }
  }
  return lenses;
}

/// What becomes of a lens: reconstructs under it, then adjusts it.
std::optional<Hypothesis> carry(const CameraModel& start, std::span<const TrackedFrame> frames,
                                const ReconstructionOptions& options) {
  ReconstructionOptions wide = options;
  wide.max_reprojection_px = 2.0 * options.max_reprojection_px;
  wide.background = false;  // the lenses themselves share the processors
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
  const std::vector<TrackedFrame> few = thinned(frames);
  const std::vector<CameraModel> lenses = lenses_to_try(width, height);
  std::vector<std::optional<Hypothesis>> hypotheses(lenses.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < lenses.size(); i = next++) {
      hypotheses[i] = carry(lenses[i], few, options);
    }
  };
  std::future<void> helper = std::async(std::launch::async, work);
  work();
  helper.get();
  // In their order, whichever was done first.
  std::optional<Hypothesis> best;
  for (const auto& hypothesis : hypotheses) {
    if (hypothesis && (!best || hypothesis->error_px < best->error_px)) best = hypothesis;
  }
  if (!best) return std::nullopt;
  return best->camera;
}

}  // namespace handeye
