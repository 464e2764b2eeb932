// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/client/scripted_daemon.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "protocol/exit_codes.hpp"

namespace handeye::test {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStatusPeriod{20};

/// A UDP port that was free a moment ago.
int free_port() {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  bind(probe, reinterpret_cast<const sockaddr*>(&address), size);
  getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
  close(probe);
  return ntohs(address.sin_port);
}

device_status_t absent_device() {
  device_status_t device{};
  device.state = device_status_t::ABSENT;
  device.rate_hz = 0;
  device.age_s = -1;
  device.received = 0;
  device.dropped = 0;
  device.dropped_queue = 0;
  device.malformed = 0;
  device.restarts = 0;
  return device;
}

}  // namespace

std::string private_provider() {
  return "udpm://239.255.76.67:" + std::to_string(free_port()) + "?ttl=0";
}

std::optional<std::string> lcm_problem() {
  try {
    const Bus bus(private_provider());
    return std::nullopt;
  } catch (const InputError& error) {
    return error.what();
  }
}

status_t idle_status() {
  status_t status{};
  status.protocol_version = request_t::VERSION;
  status.software_version = "1.2.3";
  status.uptime_s = 10;
  status.tracker = absent_device();
  status.camera = absent_device();
  status.session_state = status_t::IDLE;
  status.request_id = 0;
  status.elapsed_s = 0;
  status.max_duration_s = 0;
  status.progress = 0;
  status.sigma_rotation_deg = -1;
  status.sigma_translation_mm = -1;
  status.time_offset_sigma_s = -1;
  status.wanted_sigma_rotation_deg = 0.3;
  status.wanted_sigma_translation_mm = 1.5;
  status.features_tracked = 0;
  status.frames_collected = 0;
  status.keyframes = 0;
  status.rotation_coverage_deg = 0;
  status.translation_coverage_mm = 0;
  status.num_acks = 0;
  status.calibrated = 0;
  status.calibration_request_id = 0;
  status.undecodable = 0;
  return status;
}

result_t result_message(std::int64_t request_id, std::int32_t verdict) {
  result_t result{};
  result.request_id = request_id;
  result.verdict = verdict;
  if (verdict == result_t::REFUSED) result.reason = "single_axis";
  if (verdict == result_t::CANCELLED) result.reason = "cancelled";
  result.has_estimate = 1;
  result.q_wxyz[0] = 1;
  result.t_mm[2] = 300;
  result.time_offset_sigma_s = -1;
  result.camera_source = "given";
  return result;
}

ScriptedDaemon::ScriptedDaemon(const std::string& provider, Script script)
    : bus_(provider),
      statuses_(bus_, channels_.status),
      results_(bus_, channels_.result),
      script_(std::move(script)),
      status_(idle_status()) {
  bus_.subscribe<request_t>(channels_.request, [this](const request_t& request) { take(request); });
  thread_ = std::thread([this] { run(); });
}

ScriptedDaemon::~ScriptedDaemon() {
  stop_ = true;
  thread_.join();
}

void ScriptedDaemon::acknowledge(const request_t& request, std::int32_t code,
                                 const std::string& text) {
  if (std::ranges::count(status_.ack_request_id, request.request_id) > 0) return;
  status_.ack_request_id.insert(status_.ack_request_id.begin(), request.request_id);
  status_.ack_code.insert(status_.ack_code.begin(), code);
  status_.ack_text.insert(status_.ack_text.begin(), text);
  status_.num_acks = static_cast<std::int32_t>(status_.ack_request_id.size());
}

void ScriptedDaemon::send_result(result_t result) {
  results_.publish(result);
}

int ScriptedDaemon::times_heard(std::int64_t request_id) const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::ranges::count(requests_, request_id, &request_t::request_id));
}

std::vector<request_t> ScriptedDaemon::requests() const {
  const std::lock_guard lock(mutex_);
  return requests_;
}

std::vector<std::int64_t> ScriptedDaemon::distinct_ids(std::int32_t action) const {
  std::vector<std::int64_t> ids;
  for (const request_t& request : requests()) {
    const bool known = std::ranges::count(ids, request.request_id) > 0;
    if (request.action == action && !known) ids.push_back(request.request_id);
  }
  return ids;
}

void ScriptedDaemon::run() {
  auto next_status = std::chrono::steady_clock::now();
  while (!stop_) {
    bus_.handle(milliseconds(5));
    if (std::chrono::steady_clock::now() < next_status) continue;
    next_status = std::chrono::steady_clock::now() + kStatusPeriod;
    statuses_.publish(status_);
  }
}

void ScriptedDaemon::take(const request_t& request) {
  {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
  }
  script_(*this, request);
}

}  // namespace handeye::test
