// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_tracks.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Dense>

namespace handeye::synthetic {
namespace {

constexpr double kRelief_mm = 10;  // half the depth of the waves
constexpr double kWave_mm = 17;
constexpr double kBorder_px = 8;

/// Waves about the plane through the target that the motions look at, across the view at rest.
Eigen::Vector3d surface_point(double x, double y) {
  const double z = kRelief_mm * std::sin(x / kWave_mm) * std::cos(y / kWave_mm + 0.4);
  const Pose at_rest = still(0);
  return at_rest * Eigen::Vector3d(x, y, 80.0 + z);
}

bool sees(const CameraModel& camera, const Pose& eye_from_room, const Eigen::Vector3d& point) {
  const Eigen::Vector3d in_eye = eye_from_room * point;
  // Beyond this the distortion folds back.
  if (in_eye.z() < 15 || in_eye.head<2>().norm() > 0.9 * in_eye.z()) return false;
  const Eigen::Vector2d pixel = project<double>(camera, in_eye);
  return pixel.x() > kBorder_px && pixel.y() > kBorder_px &&
         pixel.x() < camera.width - kBorder_px && pixel.y() < camera.height - kBorder_px;
}

Eigen::Vector3d visible_point(const CameraModel& camera, const Pose& eye_from_room,
                              std::mt19937& generator) {
  std::uniform_real_distribution<double> place(-120, 120);
  for (;;) {
    const double x = place(generator);
    const Eigen::Vector3d point = surface_point(x, place(generator));
    if (sees(camera, eye_from_room, point)) return point;
  }
}

/// A feature while it is being tracked.
struct Live {
  Track track;
  Eigen::Vector2d error{Eigen::Vector2d::Zero()};  ///< in its noise
  double noise_px{0};
};

class Tracker {
 public:
  Tracker(const TrackOptions& options, std::mt19937& generator)
      : options_(options), generator_(generator) {
    result_.camera = endoscope_camera();
  }

  Tracks run() {
    for (int k = 0; k < options_.frames; ++k) {
      const int part = k * options_.parts / options_.frames;
      const Pose room_from_eye = options_.motion(options_.from_s + k / options_.rate_hz);
      result_.eye_from_room.push_back(room_from_eye.inverse());
      if (k > 0 && part != result_.part.back()) drop_all();
      result_.part.push_back(part);
      see(k, part);
    }
    drop_all();
    return std::move(result_);
  }

 private:
  void see(int frame, int part) {
    const Pose& eye_from_room = result_.eye_from_room.back();
    std::uniform_real_distribution<double> chance(0, 1);
    const double dies = 1.0 / (options_.feature_life_s * options_.rate_hz);
    std::vector<Live> still_live;
    for (Live& live : live_) {
      const bool ends =
          chance(generator_) < dies || !sees(result_.camera, eye_from_room, live.track.point_room);
      if (ends) {
        result_.tracks.push_back(std::move(live.track));
      } else {
        still_live.push_back(std::move(live));
      }
    }
    live_ = std::move(still_live);
    while (static_cast<int>(live_.size()) < options_.features) {
      Live fresh;
      fresh.track.point_room = visible_point(result_.camera, eye_from_room, generator_);
      fresh.track.part = part;
      fresh.track.first = frame;
      fresh.error = normal2();
      const bool bad = options_.bad_tracks > 0 && chance(generator_) < options_.bad_tracks;
      fresh.noise_px = bad ? options_.bad_noise_px : options_.noise_px;
      live_.push_back(std::move(fresh));
    }
    const double kept = options_.noise_memory_s > 0
                            ? std::exp(-1.0 / (options_.noise_memory_s * options_.rate_hz))
                            : 0.0;
    for (Live& live : live_) {
      live.error = kept * live.error + std::sqrt(1 - kept * kept) * normal2();
      live.track.pixels.emplace_back(
          project<double>(result_.camera, Eigen::Vector3d(eye_from_room * live.track.point_room)) +
          live.noise_px * live.error);
    }
  }

  void drop_all() {
    for (Live& live : live_) result_.tracks.push_back(std::move(live.track));
    live_.clear();
  }

  Eigen::Vector2d normal2() {
    const double x = normal_(generator_);
    return {x, normal_(generator_)};
  }

  const TrackOptions& options_;
  std::mt19937& generator_;
  std::normal_distribution<double> normal_;
  std::vector<Live> live_;
  Tracks result_;
};

}  // namespace

CameraModel endoscope_camera() {
  return {.width = 640,
          .height = 480,
          .fx = 520,
          .fy = 521,
          .cx = 322,
          .cy = 238,
          .distortion = {-0.22, 0.04, 0, 0, 0}};
}

Tracks tracks(const TrackOptions& options, std::mt19937& generator) {
  return Tracker(options, generator).run();
}

}  // namespace handeye::synthetic
