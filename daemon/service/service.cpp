// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/service.hpp"

#include <fmt/format.h>
#include <handeye/version.hpp>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include "daemon/service/calibration_in_use.hpp"
#include "daemon/service/camera_factory.hpp"
#include "daemon/service/status_message.hpp"
#include "daemon/session/result_message.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStatusPeriod{200};
constexpr double kTrackerSilentAfter_s = 1;
constexpr double kCameraSilentAfter_s = 1;

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

}  // namespace

Service::Service(const Config& config)
    : config_(config),
      camera_files_(read_camera_files(config.camera)),
      channels_(config.lcm.prefix),
      bus_(config.lcm.url),
      status_publisher_(bus_, channels_.status),
      result_publisher_(bus_, channels_.result),
      session_({.body_id = config.tracker.body_id,
                .wanted = config.calibration.wanted,
                .max_duration_s = config.calibration.max_duration_s}),
      tracker_(config.tracker, pose_options(config.camera_pose), bus_, channels_),
      camera_(make_camera(config, camera_files_.model), camera_files_.model,
              [this](const FrameStamp& stamp) { tracker_.frame_taken(stamp); }),
      vision_(camera_.frames(), bus_, vision_options(config, camera_files_, channels_)),
      solver_(tracker_.hand_samples(), vision_.tracked(), solver_options(config, camera_files_)),
      watch_(tracker_.watched_hand(), vision_.watched(),
             [this](std::int64_t request_id, WatchState state) {
               tracker_.set_watch_state({request_id, watch_code(state)});
             }),
      tracker_reporter_(kTrackerSilentAfter_s),
      camera_reporter_(kCameraSilentAfter_s),
      started_ns_(monotonic_ns()) {
  if (config.tracker.start_tracking) {
    starter_.emplace(config.tracker, [this] { return tracker_.health().last_ns.load(); });
  }
  bus_.subscribe<request_t>(channels_.request,
                            [this](const request_t& message) { on_request(message); });
  loop_.on_readable(bus_.file_descriptor(), [this] { bus_.handle(milliseconds(0)); });
  loop_.on_readable(solver_.wake_up().file_descriptor(), [this] { on_solver_events(); });
  loop_.every(kStatusPeriod, [this] { publish_status(); });
  for (const int signal : {SIGTERM, SIGINT}) {
    loop_.on_signal(signal, [this] { loop_.exit(); });
  }
}

void Service::run() {
  solver_.start();
  watch_.start();
  vision_.start();
  tracker_.start();
  if (starter_) starter_->start();
  camera_.start();
  say_ready();
  publish_status();
  loop_.run();
  sd_notify(0, "STOPPING=1");
  spdlog::info("stopping");
}

void Service::say_ready() {
  spdlog::info("ready: tracker on UDP port {}, camera {}, LCM {} with prefix {}", tracker_.port(),
               camera_.health().state().second, config_.lcm.url, config_.lcm.prefix);
  sd_notifyf(0, "READY=1\nSTATUS=tracker on port %d, prefix %s", tracker_.port(),
             config_.lcm.prefix.c_str());
}

void Service::on_request(const request_t& message) {
  std::string problem;
  auto request = read_request(message, problem);
  if (request && request->board && config_.camera.intrinsics.empty()) {
    problem = "a board needs the camera's intrinsics, and the configuration names none";
    request.reset();
  }
  if (!request) {
    spdlog::warn("request {}: {}", message.request_id, problem);
    session_.refuse({message.request_id, AckCode::kBadRequest, problem});
  } else {
    carry_out(session_.on_request(*request), *request);
  }
  publish_status();
}

void Service::carry_out(Session::Command command, const Request& request) {
  switch (command) {
    case Session::Command::kNothing:
      return;
    case Session::Command::kStart:
      return start_calibration();
    case Session::Command::kFinish:
      return solver_.finish();
    case Session::Command::kCancel:
      return solver_.cancel();
    case Session::Command::kDescribe:
      return publish_result();
    case Session::Command::kRecord:
      break;
  }
  const double duration_s =
      request.max_duration_s > 0 ? request.max_duration_s : config_.calibration.max_duration_s;
  const std::int64_t until_ns = monotonic_ns() + static_cast<std::int64_t>(1e9 * duration_s);
  tracker_.record_until(until_ns);
  vision_.record_until(until_ns);
}

void Service::start_calibration() {
  const StartOptions& start = *session_.current();
  spdlog::info(
      "calibration {}: collecting, body {}, {}, wanted sigma {} deg and {} mm, at most {} s",
      start.request_id, start.body_id, start.board ? to_string(*start.board) : "no board",
      start.wanted.rotation_deg, start.wanted.translation_mm, start.max_duration_s);
  collecting_since_ns_ = monotonic_ns();
  const std::uint64_t calibration = vision_.begin_collecting(start.board);
  tracker_.begin_collecting(start.body_id, calibration);
  solver_.begin(start, calibration);
}

void Service::on_solver_events() {
  solver_.wake_up().clear();
  while (auto event = solver_.next_event()) {
    if (std::holds_alternative<SolverThread::Solving>(*event)) {
      end_collecting();
      session_.on_solving();
    } else {
      on_result(std::get<CalibrationResult>(std::move(*event)));
    }
    publish_status();
  }
}

void Service::on_result(CalibrationResult result) {
  end_collecting();
  spdlog::info("calibration {}: {} {}", result.request_id,
               result.verdict == Verdict::kAccepted ? "accepted" : "not accepted",
               reason_word(result.reason));
  if (result.verdict == Verdict::kAccepted) activate(result);
  session_.on_result(std::move(result));
  publish_result();
}

void Service::end_collecting() {
  tracker_.end_collecting();
  vision_.end_collecting();
}

void Service::activate(const CalibrationResult& result) {
  tracker_.use(active_calibration(result, config_.tracker, monotonic_ns()));
  calibrated_request_id_ = result.request_id;
  watch_.watch(result.request_id, watched_calibration(result, config_.tracker));
  vision_.begin_watching();
}

void Service::publish_result() {
  result_t message = to_message(*session_.last_result());
  if (!result_publisher_.publish(message)) spdlog::warn("RESULT could not be sent");
}

void Service::publish_status() {
  status_t message = status_message();
  status_publisher_.publish(message);
}

status_t Service::status_message() {
  const std::int64_t now_ns = monotonic_ns();
  status_t status{};
  status.protocol_version = request_t::VERSION;
  status.software_version = kVersion;
  status.uptime_s = seconds_between(started_ns_, now_ns);
  status.tracker = tracker_reporter_.report(tracker_.health(), now_ns);
  const std::string starter = starter_ ? starter_->text() : "";
  if (!starter.empty()) status.tracker.text += fmt::format("; {}", starter);
  status.camera = camera_reporter_.report(camera_.health(), now_ns);
  const std::string_view picture = picture_text(vision_.picture());
  if (status.camera.state == device_status_t::STREAMING && !picture.empty()) {
    status.camera.text += fmt::format(": {}", picture);
  }
  status.tracked_bodies = tracker_.tracked_bodies();
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
  status.calibrated = calibrated_request_id_ != 0;
  status.calibration_request_id = calibrated_request_id_;
  write_watch(watch_.status(now_ns), status);
  status.undecodable = static_cast<std::int64_t>(bus_.undecodable());
  return status;
}

}  // namespace handeye
