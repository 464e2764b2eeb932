// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/geometry/intrinsics_mode.hpp"
#include "daemon/handeye/one_step/one_step.hpp"
#include "daemon/session/result.hpp"
#include "protocol/channels.hpp"

namespace handeye {

/// The daemon's configuration; docs/configuration.md and systemd/handeyed.toml describe every key.
struct Config {
  struct Lcm {
    std::string url{kDefaultLcmProvider};
    std::string prefix{kDefaultChannelPrefix};
    bool operator==(const Lcm&) const = default;
  } lcm;

  struct Tracker {
    std::uint16_t port{5000};     ///< UDP port the tracker sends to
    std::string bind_address;     ///< local address to listen on; empty: all
    std::string interface;        ///< network interface to listen and join on, "eth1"; empty: all
    std::string multicast_group;  ///< empty: the tracker sends to this host alone
    std::string controller;       ///< address of the tracker's controller; empty: accept any
    std::uint16_t command_port{50105};  ///< TCP port of the controller's command channel
    bool start_tracking{false};         ///< ask the controller to track, where nothing comes
    int body_id{0};                     ///< the body on the scope, the wire's number
    HandNoiseSource noise{HandNoiseSource::kMeasured};  ///< estimated where nothing is measured
    double noise_rotation_deg{0.06};                    ///< standard deviation per axis
    double noise_translation_mm{0.15};
    bool operator==(const Tracker&) const = default;
  } tracker;

  struct Camera {
    enum class Driver { kV4l2, kLcm };
    Driver driver{Driver::kV4l2};
    std::string device{"/dev/endoscope0"};  ///< v4l2
    int width{0};                           ///< px wanted of the device; 0: as the intrinsics say
    int height{0};
    double rate_hz{0};      ///< wanted of the device; 0: its own choice
    double exposure_ms{0};  ///< to shift the stamp to mid-exposure
    /// camera.json; relative to the configuration file. Empty, with kEstimate only: nothing is
    /// known of the lens, and width and height must be given.
    std::filesystem::path intrinsics;
    IntrinsicsMode intrinsics_mode{IntrinsicsMode::kFixed};
    std::filesystem::path mask;  ///< white = usable; empty: found in the image
    bool operator==(const Camera&) const = default;
  } camera;

  struct Calibration {
    WantedSigma wanted;
    double min_duration_s{8};
    double max_duration_s{30};
    bool keep{true};              ///< the last accepted one over restarts, in
    std::filesystem::path store;  ///< this file; empty: in systemd's state directory
    bool operator==(const Calibration&) const = default;
  } calibration;

  /// CAMERA_POSE, once calibrated.
  struct CameraPose {
    double wait_ms{20};     ///< for the tracker's sample after a frame; then the hand is predicted
    double predict_ms{60};  ///< that far beyond the newest sample at most; 0: never
    bool operator==(const CameraPose&) const = default;
  } camera_pose;

  struct Service {
    int realtime_priority{20};  ///< of the threads that receive, 1..99 (SCHED_RR); 0: as all others
    double stuck_after_s{20};   ///< without progress a thread is; then no watchdog is fed
    double solver_stuck_after_s{180};  ///< the same for threads that solve
    bool operator==(const Service&) const = default;
  } service;

  struct Log {
    std::string level{"info"};
    bool operator==(const Log&) const = default;
  } log;

  bool operator==(const Config&) const = default;
};

/// Reads a TOML file. Throws InputError when it cannot be read, UsageError for a mistake in it; the
/// text names file, line, key and what is allowed.
Config load_config(const std::filesystem::path& path);

}  // namespace handeye
