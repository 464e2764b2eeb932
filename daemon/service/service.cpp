// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/service.hpp"

#include <cstdlib>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/service/calibration_in_use.hpp"
#include "daemon/service/camera_factory.hpp"
#include "daemon/service/journal.hpp"
#include "daemon/service/status_message.hpp"
#include "daemon/session/result_message.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStatusPeriod{200};
constexpr double kTrackerSilentAfter_s = 1;
constexpr double kCameraSilentAfter_s = 1;

// For a slow disk, when the daemon is told to stop.
constexpr std::chrono::seconds kStoringPatience{5};

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
      tracker_(config.tracker, pose_options(config.camera_pose), bus_, channels_,
               passed_tracker_socket()),
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
      started_ns_(monotonic_ns()),
      store_(store_file(config.calibration, std::getenv("STATE_DIRECTORY"))) {
  if (config.tracker.start_tracking) {
    starter_.emplace(config.tracker, [this] { return tracker_.health().last_ns.load(); });
  }
  bus_.subscribe<request_t>(channels_.request,
                            [this](const request_t& message) { on_request(message); });
  loop_.on_readable(bus_.file_descriptor(), [this] { bus_.handle(milliseconds(0)); });
  loop_.on_readable(solver_.wake_up().file_descriptor(), [this] { on_solver_events(); });
  loop_.every(kStatusPeriod, [this] {
    all_well_ = hearts_.check(monotonic_ns());
    publish_status();
  });
  if (const auto period = SystemdLink::feeding_period()) {
    loop_.every(*period, [this] { feed_watchdog(); });
  }
  listen_to_threads();
  for (const int signal : {SIGTERM, SIGINT}) {
    loop_.on_signal(signal, [this] { loop_.exit(); });
  }
}

void Service::run() {
  restore();
  solver_.start();
  watch_.start();
  vision_.start();
  tracker_.start(config_.service.realtime_priority);
  if (starter_) starter_->start();
  camera_.start(config_.service.realtime_priority);
  say_ready();
  publish_status();
  if (in_use_) publish_result();
  loop_.run();
  SystemdLink::say_stopping();
  spdlog::info("stopping");
  if (stored_.valid()) stored_.wait_for(kStoringPatience);
}

void Service::say_ready() {
  SystemdLink::say_ready();
  log_event(Event::kReady,
            fmt::format("ready: tracker on UDP port {}, camera {}, LCM {} with prefix {}",
                        tracker_.port(), camera_.health().state().second, config_.lcm.url,
                        config_.lcm.prefix));
}

/// What was accepted before a restart, unless that is not wanted or not of this camera.
void Service::restore() {
  if (!config_.calibration.keep) {
    store_.remove();
    store_ = CalibrationStore({});
    return;
  }
  if (store_.file().empty()) {
    spdlog::info(
        "an accepted calibration will not survive a restart: neither [calibration] store "
        "nor systemd's StateDirectory= says where to keep it");
  }
  auto result = store_.load(realtime_us());
  if (!result) return;
  if (const auto problem = misfit(*result, camera_files_.model)) {
    return log_not_used(*result, *problem);
  }
  log_restored(*result);
  use(*result);
  result_since_ns_ = monotonic_ns();
  session_.on_restored(std::move(*result));
}

void Service::listen_to_threads() {
  const double limit_s = config_.service.stuck_after_s;
  hearts_.add("tracker", tracker_.heartbeat(), limit_s);
  hearts_.add("camera", camera_.heartbeat(), limit_s);
  hearts_.add("vision", vision_.heartbeat(), limit_s);
  hearts_.add("watch", watch_.heartbeat(), limit_s);
  const double solver_limit_s = config_.service.solver_stuck_after_s;
  hearts_.add("solver", solver_.heartbeat(), solver_limit_s);
  hearts_.add("attempts", solver_.attempts_heartbeat(), solver_limit_s);
  hearts_.add("final answer", solver_.final_answer_heartbeat(), solver_limit_s);
}

void Service::feed_watchdog() {
  if (all_well_) SystemdLink::feed_watchdog();
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
  log_started(start);
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
  result.vintage = Vintage{.solved_utime = realtime_us(), .age_s = 0};
  result_since_ns_ = monotonic_ns();
  log_result(result);
  const bool accepted = result.verdict == Verdict::kAccepted;
  if (accepted) use(result);
  session_.on_result(std::move(result));
  publish_result();
  if (accepted) keep(*session_.last_result());
}

void Service::end_collecting() {
  tracker_.end_collecting();
  vision_.end_collecting();
}

void Service::use(const CalibrationResult& result) {
  in_use_ = active_calibration(result, config_.tracker, monotonic_ns());
  tracker_.use(*in_use_);
  watch_.watch(result.request_id, watched_calibration(result, config_.tracker));
  vision_.begin_watching(result.camera);
}

void Service::keep(const CalibrationResult& result) {
  if (store_.file().empty()) return;
  // An older one that still waits is overtaken: the last one counts.
  stored_ = storing_.run([store = store_, result] { return store.save(result); });
}

void Service::publish_result() {
  result_t message = to_message(*session_.last_result());
  if (message.age_s >= 0) {
    message.age_s += 1e-9 * static_cast<double>(monotonic_ns() - result_since_ns_);
  }
  if (!result_publisher_.publish(message)) spdlog::warn("RESULT could not be sent");
}

}  // namespace handeye
