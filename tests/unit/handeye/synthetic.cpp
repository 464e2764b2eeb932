// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/synthetic.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace handeye::synthetic {
namespace {

Eigen::Vector3d normal3(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const double x = normal(generator);
  const double y = normal(generator);
  return {x, y, normal(generator)};
}

Pose pose_of(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = translation;
  return pose;
}

/// Three smooth signals within +-1.
Eigen::Vector3d swings(double time_s, double phase) {
  const auto swing = [&](double hz, double shift) {
    return std::sin(2 * kPi * hz * time_s + shift + phase);
  };
  return {0.6 * swing(0.31, 0.2) + 0.4 * swing(0.53, 1.0),
          0.6 * swing(0.23, 2.0) + 0.4 * swing(0.47, 0.4),
          0.6 * swing(0.37, 4.0) + 0.4 * swing(0.61, 2.2)};
}

Eigen::Vector3d turn(double time_s) {
  return rad_from_deg(20) * swings(time_s, 0);
}
Eigen::Vector3d shift_mm(double time_s) {
  return 15.0 * swings(0.9 * time_s, 1.7);
}

const Eigen::Vector3d kTarget_mm(400, -300, 900);

/// The camera looks at the target from 80 mm, turned about it.
Pose about_target(const Eigen::Vector3d& w, const Eigen::Vector3d& shift) {
  const Eigen::Matrix3d rotation = exp_so3({2.0, 0.3, -0.2}) * exp_so3(w);
  return pose_of(rotation, kTarget_mm + rotation * Eigen::Vector3d(0, 0, -80) + shift);
}

}  // namespace

Truth scope(double scale_units_per_mm) {
  Truth truth;
  truth.solution.hand_from_eye = pose_of(exp_so3({0.4, -1.9, 0.8}), {62, -25, 292});
  truth.solution.scale_units_per_mm = scale_units_per_mm;
  truth.room_from_scene = pose_of(exp_so3({-0.7, 0.5, 1.2}), {350, -280, 860});
  return truth;
}

Truth random_truth(std::mt19937& generator, double scale_units_per_mm) {
  Truth truth;
  truth.solution.hand_from_eye =
      pose_of(exp_so3(1.5 * normal3(generator)), 150 * normal3(generator));
  truth.solution.scale_units_per_mm = scale_units_per_mm;
  truth.room_from_scene = pose_of(exp_so3(1.5 * normal3(generator)), 500 * normal3(generator));
  return truth;
}

Pose free_hand(double time_s) {
  return about_target(turn(time_s), shift_mm(time_s));
}

Pose translation_only(double time_s) {
  return about_target(Eigen::Vector3d::Zero(), shift_mm(time_s));
}

Pose about_camera_centre(double time_s) {
  Pose pose = about_target(turn(time_s), Eigen::Vector3d::Zero());
  pose.translation() = kTarget_mm;
  return pose;
}

Pose one_axis(double time_s) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.8, 0.5).normalized();
  return about_target(axis * turn(time_s).x(), shift_mm(time_s));
}

Pose pivot(double time_s) {
  Pose pose = about_target(turn(time_s), Eigen::Vector3d::Zero());
  pose.translation() = kTarget_mm + pose.linear() * Eigen::Vector3d(5, -3, 150);
  return pose;
}

Motion pivot_with_shift(double shift) {
  return [shift](double time_s) {
    Pose pose = pivot(time_s);
    pose.translation() += shift / 15.0 * shift_mm(time_s);
    return pose;
  };
}

Pose still(double) {
  return about_target(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
}

std::vector<PosePair> Recording::poses() const {
  std::vector<PosePair> result;
  for (const HandEyeObservation& observation : observations) result.push_back(observation.poses);
  return result;
}

Recording record(const Truth& truth, const Motion& motion, int count, const PoseNoise& noise,
                 std::uint32_t seed, double time_offset_error_s, double eye_correlation) {
  std::mt19937 generator(seed);
  const Pose eye_from_hand = truth.solution.hand_from_eye.inverse();
  const Pose scene_from_room = truth.room_from_scene.inverse();
  // An autoregressive error whose variance stays that of independent noise.
  const double fresh = std::sqrt(1 - eye_correlation * eye_correlation);
  Eigen::Vector3d eye_turn = normal3(generator);
  Eigen::Vector3d eye_shift = normal3(generator);
  Recording recording;
  for (int k = 0; k < count; ++k) {
    const double time_s = k / 25.0;
    const double hand_time_s = time_s + time_offset_error_s;
    const auto room_from_hand = [&](double t) { return motion(t) * eye_from_hand; };
    HandEyeObservation observation;
    Pose& hand = observation.poses.room_from_hand;
    hand = room_from_hand(hand_time_s);
    const Pose before = room_from_hand(hand_time_s - 1e-4);
    const Pose after = room_from_hand(hand_time_s + 1e-4);
    observation.hand_angular_velocity =
        log_so3(before.linear().transpose() * after.linear()) / 2e-4;
    observation.hand_velocity = (after.translation() - before.translation()) / 2e-4;
    hand.linear() = hand.linear() * exp_so3(noise.hand_rotation_rad * normal3(generator));
    hand.translation() += noise.hand_translation_mm * normal3(generator);

    eye_turn = eye_correlation * eye_turn + fresh * normal3(generator);
    eye_shift = eye_correlation * eye_shift + fresh * normal3(generator);
    const Pose eye_from_scene = (scene_from_room * motion(time_s)).inverse();
    const Pose error =
        pose_of(exp_so3(noise.eye_rotation_rad * eye_turn), noise.eye_translation_mm * eye_shift);
    observation.poses.eye_from_scene = error * eye_from_scene;
    observation.poses.eye_from_scene.translation() *= truth.solution.scale_units_per_mm;
    recording.observations.push_back(observation);
  }
  return recording;
}

std::vector<PosePair> random_poses(const Truth& truth, std::mt19937& generator, int n,
                                   double max_angle_rad) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<PosePair> poses;
  for (int k = 0; k < n; ++k) {
    const Eigen::Vector3d axis = normal3(generator).normalized();
    PosePair pair;
    pair.room_from_hand =
        pose_of(exp_so3(max_angle_rad * uniform(generator) * axis), 100 * normal3(generator));
    pair.eye_from_scene = truth.solution.hand_from_eye.inverse() * pair.room_from_hand.inverse() *
                          truth.room_from_scene;
    pair.eye_from_scene.translation() *= truth.solution.scale_units_per_mm;
    poses.push_back(pair);
  }
  return poses;
}

PoseNoise tracker_and_camera() {
  return {rad_from_deg(0.06), 0.15, rad_from_deg(0.03), 0.1};
}

std::vector<Movement> all_movements(const std::vector<PosePair>& poses) {
  std::vector<Movement> movements;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      movements.push_back(movement_between(poses[i], poses[j]));
    }
  }
  return movements;
}

Vector6d error_of(const Pose& estimate, const Pose& truth) {
  Vector6d error;
  error << log_so3(truth.linear() * estimate.linear().transpose()),
      truth.translation() - estimate.translation();
  return error;
}

std::vector<PosePair> real_poses(const std::string& name) {
  const char* configured = std::getenv("HANDEYE_DATA");
  const std::filesystem::path data = configured ? configured : HANDEYE_SOURCE_DIR "/../shared/data";
  std::ifstream file(data / "poses" / name);
  std::string line;
  std::getline(file, line);
  std::vector<PosePair> poses;
  while (std::getline(file, line)) {
    std::stringstream fields(line);
    std::vector<double> v;
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    if (v.size() != 14) return {};
    poses.push_back({make_pose({v[0], v[1], v[2], v[3]}, {v[4], v[5], v[6]}),
                     make_pose({v[7], v[8], v[9], v[10]}, {v[11], v[12], v[13]})});
  }
  return poses;
}

}  // namespace handeye::synthetic
