// SPDX-License-Identifier: BSD-3-Clause
// What the service says of itself, five times a second.
#include <fmt/format.h>
#include <handeye/version.hpp>

#include "daemon/service/service.hpp"
#include "daemon/service/status_message.hpp"

namespace handeye {
namespace {

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

}  // namespace

void Service::publish_status() {
  status_t status = status_message();
  status_publisher_.publish(status);
  tracker_news_.hear(status.tracker);
  camera_news_.hear(status.camera);
  systemd_.say_status(systemd_status(status));
}

status_t Service::status_message() {
  const std::int64_t now_ns = monotonic_ns();
  status_t status{};
  status.protocol_version = request_t::VERSION;
  status.software_version = kVersion;
  status.uptime_s = seconds_between(started_ns_, now_ns);
  write_devices(now_ns, status);
  write_session(session_, status);
  write_no_progress(status);
  if (session_.state() == SessionState::kCollecting || session_.state() == SessionState::kSolving) {
    const StartOptions& start = *session_.current();
    write_progress(solver_.progress(),
                   {.wanted = start.wanted,
                    .min_duration_s = config_.calibration.min_duration_s,
                    .max_duration_s = start.max_duration_s,
                    .elapsed_s = seconds_between(collecting_since_ns_, now_ns)},
                   status);
    status.features_tracked = vision_.features_tracked();
    status.frames_collected = static_cast<std::int32_t>(vision_.frames_collected());
  }
  const WatchStatus watch = watch_.status(now_ns);
  // Seen to hold, it is as good as one of today.
  if (in_use_ && in_use_->restored && watch.state == WatchState::kHolds) {
    in_use_->restored = false;
    log_holds(in_use_->request_id);
  }
  write_calibration(in_use_, now_ns, status);
  write_watch(watch, status);
  status.undecodable = static_cast<std::int64_t>(bus_.undecodable());
  return status;
}

void Service::write_devices(std::int64_t now_ns, status_t& status) {
  status.tracker = tracker_reporter_.report(tracker_.health(), now_ns);
  const std::string starter = starter_ ? starter_->text() : "";
  if (!starter.empty()) status.tracker.text += fmt::format("; {}", starter);
  status.camera = camera_reporter_.report(camera_.health(), now_ns);
  const std::string_view picture = picture_text(vision_.picture());
  if (status.camera.state == device_status_t::STREAMING && !picture.empty()) {
    status.camera.text += fmt::format(": {}", picture);
  }
  status.tracked_bodies = tracker_.tracked_bodies();
}

}  // namespace handeye
