// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>

namespace handeye::test {
namespace {

CameraModel endoscope() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 560;
  camera.fy = 562;
  camera.cx = 322;
  camera.cy = 238;
  camera.distortion = {-0.25, 0.08, 0.0005, -0.0003, 0.0};
  return camera;
}

Eigen::Matrix3d turn(double time_s) {
  const double amplitude = rad_from_deg(18.0);
  return exp_so3(amplitude * Eigen::Vector3d(std::sin(1.1 * time_s + 0.2), std::sin(0.8 * time_s),
                                             0.6 * std::sin(0.9 * time_s + 1.0)));
}

/// A point of the scene and the feature that follows it at present.
struct ScenePoint {
  Eigen::Vector3d room;
  std::int64_t feature_id{-1};
  bool sliding{false};
  bool instrument{false};  ///< `room` holds at time 0; it moves with instrument_motion
  Eigen::Vector2d slide_px{0, 0};
  Eigen::Vector2d slide_step_px{0, 0};
};

/// How the instrument has moved since time 0.
Pose instrument_motion(double time_s) {
  const auto pose = [](double t) {
    Pose moved = Pose::Identity();
    const Eigen::Vector3d middle(20.0, 5.0, 60.0);
    moved.linear() = exp_so3(
        0.3 * Eigen::Vector3d(std::sin(2.1 * t), std::sin(1.6 * t + 0.5), std::sin(1.3 * t + 1.0)));
    moved.translation() =
        middle - moved.linear() * middle +
        8.0 * Eigen::Vector3d(std::sin(1.9 * t), std::sin(1.5 * t + 0.8), 0.5 * std::sin(1.2 * t));
    return moved;
  };
  return pose(time_s) * pose(0.0).inverse();
}

/// Adds the instrument in front of a third of the view, so many points that of the visible ones the
/// share is its own, and mixes all: the first visible ones become features first.
void add_instrument(double share, std::vector<ScenePoint>& points, std::mt19937& random) {
  constexpr double kVisibleSurfacePoints = 150.0;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int count = static_cast<int>(kVisibleSurfacePoints * share / (1.0 - share));
  for (int i = 0; i < count; ++i) {
    ScenePoint point;
    point.instrument = true;
    const double x = 14.0 + 12.0 * uniform(random);
    const double y = 22.0 * uniform(random);
    point.room = {x, y, 58.0 + 6.0 * uniform(random)};
    const auto position = static_cast<std::ptrdiff_t>(random() % (points.size() + 1));
    points.insert(points.begin() + position, point);
  }
}

/// What a point looks like: bits of its own, some of which a second look sees differently.
FeatureDescription look_at(const ScenePoint& point, const ScenePoint& first_point,
                           std::mt19937& random) {
  std::mt19937 own(static_cast<unsigned>(&point - &first_point) + 77U);
  FeatureDescription description{point.feature_id, {}};
  for (std::uint8_t& byte : description.bits) {
    byte = static_cast<std::uint8_t>(own() & 0xFFU);
    if (random() % 2 == 0) byte = static_cast<std::uint8_t>(byte ^ (1U << (random() % 8)));
  }
  return description;
}

std::vector<ScenePoint> make_surface(double relief_mm, std::mt19937& random) {
  std::uniform_real_distribution<double> across(-130.0, 130.0);
  std::vector<ScenePoint> points(1600);
  for (ScenePoint& point : points) {
    const double x = across(random);
    const double y = across(random);
    point.room = {x, y, 80.0 + relief_mm * std::sin(0.11 * x + 0.4) * std::cos(0.09 * y)};
  }
  return points;
}

}  // namespace

Motion free_hand() {
  return [](double time_s) {
    Pose room_from_eye = Pose::Identity();
    room_from_eye.linear() = turn(time_s);
    room_from_eye.translation() =
        15.0 * Eigen::Vector3d(std::sin(0.9 * time_s), std::sin(1.2 * time_s + 0.7),
                               std::sin(0.7 * time_s + 1.9));
    return room_from_eye;
  };
}

Motion turning_only() {
  return [](double time_s) {
    Pose room_from_eye = Pose::Identity();
    room_from_eye.linear() = turn(time_s);
    return room_from_eye;
  };
}

Motion sideways() {
  return [](double time_s) {
    Pose room_from_eye = Pose::Identity();
    room_from_eye.linear() = exp_so3(0.02 * Eigen::Vector3d(std::sin(time_s), std::cos(time_s), 0));
    room_from_eye.translation() = free_hand()(time_s).translation();
    return room_from_eye;
  };
}

Motion forward() {
  return [](double time_s) {
    Pose room_from_eye = Pose::Identity();
    room_from_eye.linear() =
        exp_so3(0.02 * Eigen::Vector3d(std::sin(3.0 * time_s), std::sin(2.0 * time_s), 0.0));
    room_from_eye.translation() =
        Eigen::Vector3d(0.5 * std::sin(2.5 * time_s), 0.5 * std::sin(3.5 * time_s),
                        15.0 - 15.0 * std::cos(0.5 * kPi * time_s));
    return room_from_eye;
  };
}

Motion orbit() {
  return [](double time_s) {
    const Eigen::Vector3d target(0.0, 0.0, 80.0);
    Pose room_from_eye = Pose::Identity();
    room_from_eye.linear() = turn(time_s);
    room_from_eye.translation() = target - room_from_eye.linear() * target;
    return room_from_eye;
  };
}

Motion nearly_turning(double share) {
  return [share](double time_s) {
    Pose room_from_eye = free_hand()(time_s);
    room_from_eye.translation() *= share;
    return room_from_eye;
  };
}

SyntheticTracks synthesize(const SyntheticOptions& options, const Motion& motion) {
  std::mt19937 random(options.seed);
  std::normal_distribution<double> noise(0.0, options.noise_px);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  SyntheticTracks tracks;
  tracks.camera = options.camera.value_or(endoscope());
  const CameraModel& camera = tracks.camera;
  std::vector<ScenePoint> points = make_surface(options.relief_mm, random);
  if (options.instrument_share > 0) add_instrument(options.instrument_share, points, random);
  std::mt19937 more_random(options.seed + 1000);
  std::int64_t next_id = 0;
  for (int f = 0; f < options.frames; ++f) {
    const double time_s = f / options.rate_hz;
    const Pose eye_from_room = motion(time_s).inverse();
    tracks.eye_from_room.push_back(eye_from_room);
    TrackedFrame frame;
    frame.index = f;
    frame.timestamp_ns = static_cast<std::int64_t>(std::llround(1e9 * time_s));
    std::vector<ScenePoint*> candidates;
    const Pose instrument = instrument_motion(time_s);
    const auto seen_at = [&](const ScenePoint& point) -> Eigen::Vector3d {
      return eye_from_room * (point.instrument ? instrument * point.room : point.room);
    };
    for (ScenePoint& point : points) {
      const Eigen::Vector3d eye = seen_at(point);
      Eigen::Vector2d pixel = Eigen::Vector2d::Constant(-1);
      if (eye.z() > 1) pixel = project<double>(camera, eye) + point.slide_px;
      // Beyond about 45 degrees the polynomial of the lens folds back into the image.
      const bool visible = eye.z() > 1 && eye.head<2>().norm() < eye.z() && pixel.x() > 5 &&
                           pixel.y() > 5 && pixel.x() < camera.width - 6 &&
                           pixel.y() < camera.height - 6;
      const bool blind = f >= options.blind_frame && f < options.blind_frame + options.blind_frames;
      const bool dies = blind || f == options.blind_frame || uniform(random) < options.death_rate;
      if (point.feature_id >= 0 && (!visible || dies)) {
        point.feature_id = -1;
        point.slide_px.setZero();
        point.sliding = false;
      }
      if (!visible || blind) continue;
      if (point.feature_id < 0) {
        candidates.push_back(&point);
        continue;
      }
      if (point.sliding) point.slide_px += point.slide_step_px;
      frame.observations.push_back(
          {point.feature_id, pixel + Eigen::Vector2d(noise(random), noise(random))});
    }
    for (ScenePoint* point : candidates) {
      if (static_cast<int>(frame.observations.size()) >= options.max_features) break;
      point->feature_id = next_id++;
      if (options.described) {
        frame.descriptions.push_back(look_at(*point, points.front(), more_random));
      }
      point->sliding = uniform(random) < options.outlier_tracks;
      point->slide_step_px = {2.0 * uniform(random) - 1.0, 2.0 * uniform(random) - 1.0};
      const Eigen::Vector2d pixel = project<double>(camera, seen_at(*point));
      frame.observations.push_back(
          {point->feature_id, pixel + Eigen::Vector2d(noise(random), noise(random))});
    }
    std::sort(frame.observations.begin(), frame.observations.end(),
              [](const auto& a, const auto& b) { return a.feature_id < b.feature_id; });
    tracks.frames.push_back(std::move(frame));
  }
  return tracks;
}

AlignmentError compare(const std::vector<RegisteredFrame>& frames, const std::vector<Pose>& truth) {
  const auto count = static_cast<Eigen::Index>(frames.size());
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  Eigen::Matrix3Xd centres(3, count);
  Eigen::Matrix3Xd true_centres(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const RegisteredFrame& frame = frames[static_cast<std::size_t>(i)];
    const Pose& true_pose = truth.at(static_cast<std::size_t>(frame.index));
    correlation += true_pose.linear().transpose() * frame.eye_from_scene.linear();
    centres.col(i) = frame.eye_from_scene.inverse().translation();
    true_centres.col(i) = true_pose.inverse().translation();
  }
  const Eigen::Matrix3d room_from_scene = nearest_rotation(correlation);
  AlignmentError error;
  for (const RegisteredFrame& frame : frames) {
    const Pose& true_pose = truth.at(static_cast<std::size_t>(frame.index));
    const double angle_deg = deg_from_rad(
        rotation_angle_rad(frame.eye_from_scene.linear(), true_pose.linear() * room_from_scene));
    error.rotation_rms_deg += angle_deg * angle_deg / static_cast<double>(count);
    error.rotation_max_deg = std::max(error.rotation_max_deg, angle_deg);
  }
  error.rotation_rms_deg = std::sqrt(error.rotation_rms_deg);
  const Eigen::Matrix4d similarity = Eigen::umeyama(centres, true_centres, true);
  const Eigen::Matrix3Xd aligned = (similarity.topLeftCorner<3, 3>() * centres).colwise() +
                                   similarity.topRightCorner<3, 1>().eval();
  error.centre_rms = std::sqrt((aligned - true_centres).squaredNorm() / static_cast<double>(count));
  const Eigen::Vector3d mean = true_centres.rowwise().mean();
  error.extent =
      std::sqrt((true_centres.colwise() - mean).squaredNorm() / static_cast<double>(count));
  return error;
}

}  // namespace handeye::test
