// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/listener.hpp"

#include <algorithm>

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

request_t new_request(std::int32_t action) {
  request_t request{};
  request.protocol_version = request_t::VERSION;
  request.request_id = random_id();
  request.action = action;
  request.body_id = -1;
  return request;
}

}  // namespace

Listener::Listener(const std::string& lcm_url)
    : bus_(lcm_url), requests_(bus_, channels_.request), frames_(bus_, channels_.frame) {
  bus_.subscribe<status_t>(channels_.status,
                           [this](const status_t& status) { statuses_.push_back(status); });
  bus_.subscribe<result_t>(channels_.result,
                           [this](const result_t& result) { results_.push_back(result); });
}

void Listener::hear_poses() {
  bus_.subscribe<camera_pose_t>(channels_.camera_pose,
                                [this](const camera_pose_t& pose) { poses_.push_back(pose); });
  bus_.subscribe<tracker_frame_t>(channels_.tracker, [this](const tracker_frame_t& frame) {
    tracker_frames_.push_back(frame);
  });
}

void Listener::hear_frames() {
  bus_.subscribe<image_t>(channels_.frame, [this](const image_t& image) { last_frame_ = image; });
}

bool Listener::spin_until(const std::function<bool()>& condition, milliseconds timeout) {
  const auto deadline = steady_clock::now() + timeout;
  while (!condition()) {
    if (steady_clock::now() > deadline) return false;
    bus_.handle(milliseconds(10));
  }
  return true;
}

void Listener::spin_for(milliseconds duration) {
  spin_until([] { return false; }, duration);
}

void Listener::send(request_t request) {
  requests_.publish(request);
}

bool Listener::ask(const request_t& request, milliseconds timeout) {
  constexpr milliseconds kRepeat{250};
  const auto deadline = steady_clock::now() + timeout;
  const auto acknowledged = [&] { return ack_code(request.request_id).has_value(); };
  do {
    send(request);
    if (spin_until(acknowledged, kRepeat)) return true;
  } while (steady_clock::now() < deadline);
  return false;
}

void Listener::send_frame(image_t image) {
  frames_.publish(image);
}

std::int64_t Listener::session_state() const {
  return statuses_.empty() ? -1 : statuses_.back().session_state;
}

std::int64_t Listener::running_request() const {
  return statuses_.empty() ? -1 : statuses_.back().request_id;
}

std::optional<std::int32_t> Listener::ack_code(std::int64_t request_id) const {
  if (statuses_.empty()) return std::nullopt;
  const status_t& status = statuses_.back();
  const auto found = std::ranges::find(status.ack_request_id, request_id);
  if (found == status.ack_request_id.end()) return std::nullopt;
  return status.ack_code[static_cast<std::size_t>(found - status.ack_request_id.begin())];
}

std::string Listener::ack_text(std::int64_t request_id) const {
  if (!ack_code(request_id)) return "";
  const status_t& status = statuses_.back();
  const auto found = std::ranges::find(status.ack_request_id, request_id);
  return status.ack_text[static_cast<std::size_t>(found - status.ack_request_id.begin())];
}

const result_t* Listener::result_of(std::int64_t request_id) const {
  const auto found = std::ranges::find(results_, request_id, &result_t::request_id);
  return found == results_.end() ? nullptr : &*found;
}

request_t start_request(double max_duration_s) {
  request_t request = new_request(request_t::START);
  request.max_duration_s = max_duration_s;
  return request;
}

request_t cancel_request(std::int64_t target_request_id) {
  request_t request = new_request(request_t::CANCEL);
  request.target_request_id = target_request_id;
  return request;
}

}  // namespace handeye::test
