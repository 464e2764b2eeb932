// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <optional>

#include <handeye/request_t.hpp>
#include <handeye/result_t.hpp>
#include <handeye/status_t.hpp>

#include "daemon/config/config.hpp"
#include "daemon/service/background_thread.hpp"
#include "daemon/service/calibration_store.hpp"
#include "daemon/service/camera_thread.hpp"
#include "daemon/service/event_loop.hpp"
#include "daemon/service/heart_monitor.hpp"
#include "daemon/service/news.hpp"
#include "daemon/service/service_options.hpp"
#include "daemon/service/solver_thread.hpp"
#include "daemon/service/systemd_link.hpp"
#include "daemon/service/tracker_starter.hpp"
#include "daemon/service/tracker_thread.hpp"
#include "daemon/service/vision_thread.hpp"
#include "daemon/service/watch_thread.hpp"
#include "daemon/session/session.hpp"
#include "protocol/bus.hpp"
#include "protocol/channels.hpp"

namespace handeye {

/// The daemon: devices and solver in threads of their own, and this, the main thread, which talks
/// to clients: takes requests, reports status five times a second, publishes results. Devices may
/// be absent, come and go; only what cannot be had at all (port in use, no multicast route,
/// unusable files) throws InputError from the constructor.
class Service {
 public:
  explicit Service(const Config& config);

  /// Until SIGTERM or SIGINT.
  void run();

 private:
  void on_request(const request_t& message);
  void carry_out(Session::Command command, const Request& request);
  void start_calibration();
  void on_solver_events();
  void on_result(CalibrationResult result);
  void end_collecting();
  void restore();
  void use(const CalibrationResult& result);
  void keep(const CalibrationResult& result);
  void publish_result();
  void listen_to_threads();
  void feed_watchdog();
  void publish_status();
  status_t status_message();
  void write_devices(std::int64_t now_ns, status_t& status);
  void say_ready();

  Config config_;
  CameraFiles camera_files_;
  EventLoop loop_;
  Channels channels_;
  Bus bus_;
  Publisher<status_t> status_publisher_;
  Publisher<result_t> result_publisher_;
  Session session_;
  TrackerThread tracker_;
  std::optional<TrackerStarter> starter_;  ///< where the configuration asks for it
  CameraThread camera_;
  VisionThread vision_;
  SolverThread solver_;
  WatchThread watch_;
  DeviceStatusReporter tracker_reporter_;
  DeviceStatusReporter camera_reporter_;
  DeviceNews tracker_news_{"tracker"};
  DeviceNews camera_news_{"camera"};
  std::int64_t started_ns_;
  std::int64_t collecting_since_ns_{0};
  std::int64_t result_since_ns_{0};  ///< when the last result's age was that of its vintage
  std::optional<ActiveCalibration> in_use_;
  SystemdLink systemd_;
  HeartMonitor hearts_;
  bool all_well_{true};  ///< no thread is stuck
  CalibrationStore store_;
  std::future<bool> stored_;
  BackgroundThread storing_{"storing"};  ///< a disk may take its time
};

}  // namespace handeye
