// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/board.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "drivers/simulator/disturbance.hpp"
#include "drivers/simulator/fault.hpp"
#include "drivers/simulator/head_turn.hpp"
#include "drivers/simulator/motion.hpp"
#include "drivers/simulator/scene_kind.hpp"
#include "drivers/simulator/surface.hpp"

namespace handeye::simulator {

/// How the tracker tells the time of a measurement.
enum class Timestamps {
  kSecondsOfDay,  ///< ts
  kUnixTime,      ///< ts2
  kNone,
};

/// What the user chooses; everything else is drawn from the seed.
struct SimulatorOptions {
  std::uint64_t seed{0};
  MotionKind motion{MotionKind::kFree};
  double largest_turn_deg{20.0};  ///< about each axis
  double largest_shift_mm{15.0};  ///< along each axis
  SceneKind scene{SceneKind::kTissue};
  std::optional<Board> board;                 ///< what is looked at instead
  int width{640};                             ///< px
  int height{480};                            ///< px
  std::optional<std::array<double, 2>> lens;  ///< k1 and k2 instead of drawn ones
  double image_noise_grey{1.5};               ///< standard deviation, grey levels
  Disturbances disturbances;
  double camera_rate_hz{25.0};
  double tracker_rate_hz{60.0};
  double tracker_noise_deg{0.06};  ///< standard deviation per axis
  double tracker_noise_mm{0.15};   ///< standard deviation per axis
  int body_id{0};                  ///< the wire's number
  int jpeg_quality{90};            ///< 1..100; less where a frame would become too large
  std::vector<Fault> tracker_faults;
  std::vector<Fault> camera_faults;
  std::optional<double> midnight_s;  ///< simulated time at which the tracker's day ends; else drawn
  Timestamps timestamps{Timestamps::kSecondsOfDay};
  bool covariance{false};  ///< the tracker says (6dcov) how well it saw the body each time
  std::optional<HeadTurn> head_turn;
};

/// Everything that is true in a simulation. The host's clock counts ns; simulated time is seconds
/// since the start.
struct World {
  /// Draws a world whose simulation starts at this instant of the host's clock. Throws UsageError
  /// when the board cannot be drawn.
  World(const SimulatorOptions& options, std::int64_t start_ns);

  /// Where the eye is, its head turned or not; the motion itself is what the scope does.
  Pose surface_from_eye(double time_s) const;
  Pose room_from_eye(double time_s) const;
  Pose room_from_hand(double time_s) const;

  /// As it is at a time: hand_from_eye until the head is turned.
  Pose hand_from_eye_at(double time_s) const;

  /// Nothing where there is no board.
  std::optional<Pose> room_from_board() const;

  /// The tracker's clock, seconds of its day in [0, 86400).
  double tracker_clock_s(double time_s) const;
  /// The same clock counted on through midnight: seconds since the day began that the simulation
  /// starts on.
  double tracker_day_s(double time_s) const;

  std::int64_t host_ns(double time_s) const;

  /// What must be added to a tracker time stamp (which the clock model has mapped to the host's
  /// clock, constant latency included) to get the camera's stamp of the same instant.
  double time_offset_s() const { return camera_delay_s - tracker_latency_s; }

  SimulatorOptions options;
  std::int64_t start_ns;
  CameraModel camera;
  Surface surface;
  Motion motion;
  Pose room_from_surface;
  Pose hand_from_eye;                 ///< at the start
  std::vector<Fault> tracker_faults;  ///< as chosen, each that happens once with its time
  std::vector<Fault> camera_faults;
  double tracker_latency_s{0};      ///< constant part, measurement to arrival
  double tracker_jitter_s{0.001};   ///< mean of what comes on top, never negative
  double tracker_clock_start_s{0};  ///< what the tracker's clock shows at the start
  double tracker_clock_drift{0};    ///< its rate against the host's, minus 1
  double camera_delay_s{0};         ///< mid-exposure to the frame's time stamp
};

}  // namespace handeye::simulator
