// SPDX-License-Identifier: BSD-3-Clause
// How far off features are for the watch over a calibration, which sees them at times only and for
// as long as they live: watch_noise [SEEDS [SECONDS]], on rendered pictures, against the truth.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>

#include "daemon/session/calibration_watch_equations.hpp"
#include "daemon/session/image_stage.hpp"
#include "drivers/simulator/endoscope_view.hpp"

namespace handeye::simulator {
namespace {

constexpr std::size_t kWindow = 40;
constexpr double kGuess_px = 0.4;

/// Of a feature, per axis: of the half that is off least, as if normal, and of all within the bend
/// of the watch's loss.
struct Noise {
  std::vector<double> off_px;

  double central_px() const { return quantile(0.5) / std::sqrt(2.0 * std::log(2.0)); }
  double inliers_px() const {
    double squared = 0;
    std::size_t count = 0;
    for (const double off : off_px) {
      if (off > 4.0 * kGuess_px) continue;
      squared += 0.5 * off * off;
      ++count;
    }
    return std::sqrt(squared / static_cast<double>(count));
  }
  double quantile(double share) const {
    std::vector<double> sorted = off_px;
    const auto at = sorted.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::ranges::nth_element(sorted, at);
    return *at;
  }
};

/// Residuals of a window's features at the eyes as they truly were, each point where it fits best.
void add_window(const World& world, const std::vector<WatchFrame>& frames, Noise& noise) {
  WatchUnknowns at;
  for (const WatchFrame& frame : frames) {
    at.room_from_eye.push_back(frame.room_from_hand * world.hand_from_eye);
  }
  at.tracks = watch_tracks(frames, 3);
  place_points(at.room_from_eye, at.tracks);
  const double focal_px = 0.5 * (world.camera.fx + world.camera.fy);
  settle_points({.image = kGuess_px / focal_px, .robust_image = 4.0 * kGuess_px / focal_px}, at);
  for (const WatchTrack& track : at.tracks) {
    for (const WatchTrack::Sight& sight : track.sights) {
      const auto seen = watch_ray(track, at.room_from_eye[static_cast<std::size_t>(sight.frame)]);
      if (seen) noise.off_px.push_back(focal_px * (*seen - sight.ray).norm());
    }
  }
}

void watch_pictures(const World& world, double duration_s, std::uint32_t every, Noise& noise) {
  EndoscopeView view(world);
  const auto images = make_image_stage(std::nullopt, {}, world.camera);
  std::vector<WatchFrame> frames;
  Frame frame;
  TrackedFrame tracked;
  const auto count = static_cast<std::uint32_t>(duration_s * world.options.camera_rate_hz);
  for (std::uint32_t number = 0; number < count; number += every) {
    const double exposed_s = view.exposed_s(number);
    frame.sequence = number;
    frame.timestamp_ns = world.host_ns(exposed_s);
    view.draw(number, frame.grey);
    images->process(frame, tracked);
    const HandLookup hand{.status = LookupStatus::kOk,
                          .room_from_hand = world.room_from_hand(exposed_s)};
    frames.push_back(make_watch_frame(world.camera, tracked, hand, {}));
    if (frames.size() < kWindow) continue;
    add_window(world, frames, noise);
    frames.clear();
  }
}

}  // namespace
}  // namespace handeye::simulator

int main(int argc, char** argv) {
  using namespace handeye::simulator;
  const auto seeds = static_cast<unsigned>(argc > 1 ? std::atoi(argv[1]) : 4);
  const double duration_s = argc > 2 ? std::atof(argv[2]) : 20.0;
  for (const std::uint32_t every : {2U, 5U}) {
    for (const int width : {320, 640}) {
      for (unsigned seed = 1; seed <= seeds; ++seed) {
        const World world({.seed = seed, .width = width, .height = width * 3 / 4}, 1'000'000'000);
        Noise noise;
        watch_pictures(world, duration_s, every, noise);
        fmt::print(
            "every {:3} ms, {}x{}, seed {}: central {:.2f} px, inliers {:.2f} px, 90 % within "
            "{:.2f} "
            "px, 99 % {:.2f} px, {} sights\n",
            40 * every, width, width * 3 / 4, seed, noise.central_px(), noise.inliers_px(),
            noise.quantile(0.9), noise.quantile(0.99), noise.off_px.size());
      }
    }
  }
}
