// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/types.hpp"

/// Motions with known truth, and the real poses.
namespace handeye::synthetic {

struct Truth {
  HandEyeSolution solution;
  Pose room_from_scene{Pose::Identity()};  ///< scene in mm
};

/// A scope: camera turned about all axes against the hand, 300 mm away.
Truth scope(double scale_units_per_mm = 1.0);

/// Random hand_from_eye, scene and scale.
Truth random_truth(std::mt19937& generator, double scale_units_per_mm);

/// room_from_eye as a function of time [s].
using Motion = std::function<Pose(double time_s)>;

/// Free hand, as the simulator moves: smooth, +-20 deg and +-15 mm an axis round a point 80 mm
/// away.
Pose free_hand(double time_s);
/// As free_hand, without the rotation.
Pose translation_only(double time_s);
/// As free_hand, without moving the camera's centre.
Pose about_camera_centre(double time_s);
/// About one axis of the room only, with free translation.
Pose one_axis(double time_s);
/// About a point 150 mm behind the camera that stays where it is, all axes.
Pose pivot(double time_s);
/// As pivot, the point shifted as free_hand shifts, within +-shift_mm an axis.
Motion pivot_with_shift(double shift_mm);
Pose still(double time_s);

struct Recording {
  std::vector<HandEyeObservation> observations;
  std::vector<PosePair> poses() const;
};

/// `count` poses at 25 Hz with independent Gaussian noise. Hand stamps err by time_offset_error_s:
/// the hand of t + time_offset_error_s is measured for the eye of t.
Recording record(const Truth& truth, const Motion& motion, int count, const PoseNoise& noise,
                 std::uint32_t seed, double time_offset_error_s = 0, double eye_correlation = 0);

/// n poses at random rotations up to max_angle_rad about any axis; exact.
std::vector<PosePair> random_poses(const Truth& truth, std::mt19937& generator, int n,
                                   double max_angle_rad);

PoseNoise tracker_and_camera();  ///< the simulator's: 0.06 deg, 0.15 mm; 0.03 deg, 0.1 mm

/// All movements i < j.
std::vector<Movement> all_movements(const std::vector<PosePair>& poses);

/// (w, dt) with R_truth = Exp(w) R_estimate, t_truth = t_estimate + dt: what the covariance is of.
Vector6d error_of(const Pose& estimate, const Pose& truth);

/// Rows of poses/NAME of the real data; empty where the data are not there.
std::vector<PosePair> real_poses(const std::string& name);

}  // namespace handeye::synthetic
