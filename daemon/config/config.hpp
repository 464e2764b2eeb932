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
  } lcm;

  struct Tracker {
    std::uint16_t port{5000};     ///< UDP port the tracker sends to
    std::string bind_address;     ///< local address to listen on; empty: all
    std::string interface;        ///< network interface to listen and join on, "eth1"; empty: all
    std::string multicast_group;  ///< empty: the tracker sends to this host alone
    std::string controller;       ///< address of the tracker's controller; empty: accept any
    int body_id{0};               ///< the body on the scope, the wire's number
    HandNoiseSource noise{HandNoiseSource::kMeasured};  ///< estimated where nothing is measured
    double noise_rotation_deg{0.06};                    ///< standard deviation per axis
    double noise_translation_mm{0.15};
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
  } camera;

  struct Calibration {
    WantedSigma wanted;
    double min_duration_s{8};
    double max_duration_s{30};
  } calibration;

  /// CAMERA_POSE, once calibrated.
  struct CameraPose {
    double wait_ms{20};     ///< for the tracker's sample after a frame; then the hand is predicted
    double predict_ms{60};  ///< that far beyond the newest sample at most; 0: never
  } camera_pose;

  struct Log {
    std::string level{"info"};
  } log;
};

/// Reads a TOML file. Throws InputError when it cannot be read, UsageError for a mistake in it; the
/// text names file, line, key and what is allowed.
Config load_config(const std::filesystem::path& path);

}  // namespace handeye
