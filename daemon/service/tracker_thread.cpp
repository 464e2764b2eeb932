// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/tracker_thread.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <poll.h>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/service/thread_role.hpp"
#include "daemon/session/pose_message.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;

// Short enough to notice silence, and the end, in time.
constexpr milliseconds kWait{20};
// A minute at 60 Hz, should the solver be that busy.
constexpr std::size_t kHandSamples = 4096;
// 8 s, should the watch be looking.
constexpr std::size_t kWatchedHand = 512;
// STATUS goes out five times a second.
constexpr std::int64_t kClockReportPeriod_ns = 100'000'000;
constexpr std::size_t kFrameStamps = 256;
// Bodies beyond are tracked and published, only STATUS does not list them.
constexpr std::int32_t kBodiesInStatus = 64;

dtrack::ReceiverOptions receiver_options(const Config::Tracker& config,
                                         std::optional<int> passed_socket) {
  dtrack::ReceiverOptions options;
  options.port = config.port;
  options.bind_address = config.bind_address;
  options.interface = config.interface;
  options.multicast_group = config.multicast_group;
  options.source_address = config.controller;
  options.controller_address = config.controller;
  options.passed_descriptor = passed_socket;
  return options;
}

}  // namespace

TrackerThread::TrackerThread(const Config::Tracker& config,
                             const PosePublisherOptions& camera_poses, Bus& bus,
                             const Channels& channels, std::optional<int> passed_socket)
    : config_(config),
      receiver_(receiver_options(config, passed_socket)),
      hand_stream_(config.body_id),
      frame_publisher_(bus, channels.tracker),
      datagram_publisher_(bus, channels.datagram),
      pose_publisher_(bus, channels.camera_pose, camera_poses),
      collecting_(Collecting{0, config.body_id}),
      hand_samples_(kHandSamples),
      watched_hand_(kWatchedHand),
      calibrations_(4),
      watch_words_(64),
      frame_stamps_(kFrameStamps) {
  health_.set(device_status_t::WAITING,
              fmt::format("waiting for packets on port {}", receiver_.port()));
  if (passed_socket) say_taken_over();
}

void TrackerThread::say_taken_over() const {
  spdlog::info("tracker: systemd's socket on port {}, {} datagrams from before are dropped",
               receiver_.port(), receiver_.counters().stale);
  if (config_.port != 0 && config_.port != receiver_.port()) {
    spdlog::warn("tracker: the configuration says port {}, systemd's socket has {}", config_.port,
                 receiver_.port());
  }
}

void TrackerThread::start(int realtime_priority) {
  thread_ = std::jthread([this, realtime_priority](const std::stop_token& stop) {
    take_role({"tracker", realtime_priority});
    run(stop);
  });
}

void TrackerThread::begin_collecting(int body_id, std::uint64_t calibration) {
  collecting_ = Collecting{static_cast<std::uint32_t>(calibration), body_id};
}

void TrackerThread::end_collecting() {
  collecting_ = Collecting{0, collecting_.load().body_id};
}

void TrackerThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    heartbeat_.beat();
    wait_for_work();
    receiver_.receive(milliseconds(0), [this](const Datagram& datagram) { take(datagram); });
    while (const auto calibration = calibrations_.pop()) pose_publisher_.use(*calibration);
    while (const auto word = watch_words_.pop()) pose_publisher_.hear(*word);
    while (const auto stamp = frame_stamps_.pop()) pose_publisher_.add_frame(*stamp);
    pose_publisher_.publish_ready(monotonic_ns());
  }
}

/// Until a datagram or a frame is there, or a camera pose is due without.
void TrackerThread::wait_for_work() {
  std::int64_t wait_ns = std::chrono::nanoseconds(kWait).count();
  const std::int64_t now_ns = monotonic_ns();
  if (const auto due_ns = pose_publisher_.due_ns(now_ns)) {
    wait_ns = std::clamp<std::int64_t>(*due_ns - now_ns, 0, wait_ns);
  }
  std::array<pollfd, 2> waited_for{pollfd{receiver_.file_descriptor(), POLLIN, 0},
                                   pollfd{frame_came_.file_descriptor(), POLLIN, 0}};
  const timespec timeout{0, wait_ns};
  if (ppoll(waited_for.data(), waited_for.size(), &timeout, nullptr) <= 0) return;
  if ((waited_for[1].revents & POLLIN) != 0) frame_came_.clear();
}

void TrackerThread::frame_taken(FrameStamp stamp) {
  stamp.arrival_ns = monotonic_ns();
  frame_stamps_.push(stamp);
  frame_came_.signal();
}

void TrackerThread::take(const Datagram& datagram) {
  publish_datagram(datagram);
  const Collecting collecting = collecting_;
  hand_stream_.set_body_id(collecting.body_id);
  const auto sample = hand_stream_.take(datagram);
  if (!sample) {
    count_datagram();
    return;
  }
  monitor_.observe(hand_stream_.frame().number);
  count_datagram();
  report_clock();
  publish_frame(datagram, *sample);
  distribute(*sample, collecting.calibration);
}

void TrackerThread::report_clock() {
  const std::int64_t now_ns = monotonic_ns();
  if (now_ns - clock_reported_ns_ < kClockReportPeriod_ns) return;
  clock_reported_ns_ = now_ns;
  const ClockReport report = hand_stream_.clock_report();
  health_.set_clock(report);
  if (report.jumps != jumps_) spdlog::warn("tracker: its clock has jumped");
  jumps_ = report.jumps;
}

void TrackerThread::count_datagram() {
  const dtrack::ReceiverCounters& received = receiver_.counters();
  const dtrack::ParseCounters& parsed = hand_stream_.counters();
  if (health_.last_ns == 0) {
    health_.set(device_status_t::STREAMING, fmt::format("port {}", receiver_.port()));
  }
  health_.last_ns = monotonic_ns();
  health_.received = static_cast<std::int64_t>(received.received);
  health_.dropped = static_cast<std::int64_t>(monitor_.lost());
  health_.dropped_queue =
      static_cast<std::int64_t>(received.kernel_drops + hand_samples_.dropped());
  health_.malformed = static_cast<std::int64_t>(parsed.rejected_datagrams + parsed.rejected_lines +
                                                parsed.rejected_bodies + received.empty +
                                                hand_stream_.bad_covariances());
  health_.restarts = static_cast<std::int64_t>(monitor_.restarts());
  health_.reordered = static_cast<std::int64_t>(monitor_.late());
}

void TrackerThread::publish_frame(const Datagram& datagram, const HandSample& sample) {
  const dtrack::Frame& frame = hand_stream_.frame();
  frame_message_.frame_number = frame.number;
  frame_message_.device_time_s = frame.seconds_of_day.value_or(-1);
  frame_message_.arrival_ns = datagram.arrival_ns;
  frame_message_.timestamp_ns = sample.doubtful_time ? 0 : sample.timestamp_ns;
  frame_message_.bodies.resize(frame.bodies.size());
  frame_message_.num_bodies = static_cast<std::int32_t>(frame.bodies.size());
  std::uint64_t tracked = 0;
  for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
    const dtrack::Body& body = frame.bodies[i];
    frame_message_.bodies[i] = body_message(body);
    if (body.tracked && body.id < kBodiesInStatus) tracked |= std::uint64_t{1} << body.id;
  }
  tracked_bodies_ = tracked;
  frame_publisher_.publish(frame_message_);
}

void TrackerThread::publish_datagram(const Datagram& datagram) {
  if (monotonic_ns() >= record_until_ns_) return;
  datagram_message_.arrival_ns = datagram.arrival_ns;
  datagram_message_.data.assign(datagram.bytes.begin(), datagram.bytes.end());
  datagram_message_.size = static_cast<std::int32_t>(datagram_message_.data.size());
  datagram_publisher_.publish(datagram_message_);
}

void TrackerThread::distribute(const HandSample& sample, std::uint32_t collecting_for) {
  if (collecting_for != 0) hand_samples_.push({collecting_for, sample});
  const auto& calibration = pose_publisher_.calibration();
  if (!calibration) return;
  // Another body may be collected meanwhile than the one that is calibrated.
  const HandSample calibrated = calibration->body_id == hand_stream_.body_id()
                                    ? sample
                                    : hand_stream_.sample_of(calibration->body_id);
  pose_publisher_.add_hand(calibrated);
  watched_hand_.push({calibration->request_id, calibrated});
}

std::string TrackerThread::tracked_bodies() const {
  const std::uint64_t tracked = tracked_bodies_;
  std::string ids;
  for (std::int32_t id = 0; id < kBodiesInStatus; ++id) {
    if ((tracked >> id & 1) == 0) continue;
    if (!ids.empty()) ids += ' ';
    ids += std::to_string(id);
  }
  return ids;
}

body_t TrackerThread::body_message(const dtrack::Body& body) {
  body_t message{};
  message.body_id = body.id;
  message.tracked = body.tracked;
  if (body.tracked) write_pose(body.room_from_body, message.q_wxyz, message.t_mm);
  return message;
}

}  // namespace handeye
