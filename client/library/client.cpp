// SPDX-License-Identifier: BSD-3-Clause
#include "client/library/client.hpp"

#include <algorithm>
#include <utility>

#include "protocol/bus.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::size_t kAcknowledgementsKept = 64;

Channels checked_channels(const std::string& prefix) {
  if (!is_valid_channel_prefix(prefix)) {
    throw UsageError("channel prefix '" + prefix +
                     "': at most 40 letters, digits, '_' and '-' are allowed");
  }
  return Channels(prefix);
}

/// A request with every field set; LCM's types do not initialise theirs.
request_t make_request(std::int32_t action, std::int64_t target_request_id) {
  request_t request;
  request.utime = 0;
  request.session_id = 0;
  request.seq = 0;
  request.protocol_version = request_t::VERSION;
  request.request_id = random_id();
  request.action = action;
  request.target_request_id = target_request_id;
  request.body_id = -1;
  request.wanted_sigma_rotation_deg = 0;
  request.wanted_sigma_translation_mm = 0;
  request.max_duration_s = 0;
  request.eye = request_t::EYE_SFM;
  return request;
}

}  // namespace

Client::Client(const ClientOptions& options) : request_period_(options.request_period) {
  const Channels channels = checked_channels(options.channel_prefix);
  bus_ = std::make_unique<Bus>(options.lcm_url);
  requests_ = std::make_unique<Publisher<request_t>>(*bus_, channels.request);
  bus_->subscribe<status_t>(channels.status,
                            [this](const status_t& status) { take_status(status); });
  bus_->subscribe<result_t>(channels.result, [this](const result_t& result) {
    if (on_result_) on_result_(result);
  });
}

Client::~Client() = default;

std::int64_t Client::start(const StartRequest& wanted) {
  request_t request = make_request(request_t::START, 0);
  request.body_id = wanted.body_id;
  request.wanted_sigma_rotation_deg = wanted.wanted_sigma_rotation_deg;
  request.wanted_sigma_translation_mm = wanted.wanted_sigma_translation_mm;
  request.max_duration_s = wanted.max_duration_s;
  if (!wanted.board.empty()) request.eye = request_t::EYE_PATTERN;
  request.board = wanted.board;
  return send(request);
}

std::int64_t Client::finish(std::int64_t target_request_id) {
  return send(make_request(request_t::FINISH, target_request_id));
}

std::int64_t Client::cancel(std::int64_t target_request_id) {
  return send(make_request(request_t::CANCEL, target_request_id));
}

std::int64_t Client::describe() {
  return send(make_request(request_t::DESCRIBE, 0));
}

std::int64_t Client::record(double duration_s) {
  request_t request = make_request(request_t::RECORD, 0);
  request.max_duration_s = duration_s;
  return send(request);
}

void Client::stop_repeating(std::int64_t request_id) {
  for (Pending& pending : pending_) {
    if (pending.request.request_id == request_id) pending.due.reset();
  }
}

void Client::abandon(std::int64_t request_id) {
  std::erase_if(pending_,
                [&](const Pending& pending) { return pending.request.request_id == request_id; });
}

std::optional<Acknowledgement> Client::acknowledgement(std::int64_t request_id) const {
  for (const Acknowledgement& known : acknowledgements_) {
    if (known.request_id == request_id) return known;
  }
  return std::nullopt;
}

bool Client::spin_once(std::chrono::milliseconds timeout) {
  send_due();
  const auto wait = std::min(timeout, next_send_in().value_or(timeout));
  const bool handled = bus_->handle(wait);
  send_due();
  return handled;
}

int Client::file_descriptor() const {
  return bus_->file_descriptor();
}

std::optional<std::chrono::milliseconds> Client::next_send_in() const {
  std::optional<Clock::time_point> earliest;
  for (const Pending& pending : pending_) {
    if (pending.due && (!earliest || *pending.due < *earliest)) earliest = pending.due;
  }
  if (!earliest) return std::nullopt;
  // Rounded up: waking a fraction of a millisecond early would spin.
  const auto wait = std::chrono::ceil<std::chrono::milliseconds>(*earliest - Clock::now());
  return std::max(wait, std::chrono::milliseconds(0));
}

std::uint64_t Client::undecodable() const {
  return bus_->undecodable();
}

std::int64_t Client::send(request_t request) {
  // A failed send (interface down) needs no care: the repetition makes good for it.
  requests_->publish(request);
  pending_.push_back({request, Clock::now() + request_period_});
  return request.request_id;
}

void Client::send_due() {
  const auto now = Clock::now();
  for (Pending& pending : pending_) {
    if (!pending.due || *pending.due > now) continue;
    requests_->publish(pending.request);
    pending.due = now + request_period_;
  }
}

void Client::take_status(const status_t& status) {
  take_acknowledgements(status);
  last_status_ = status;
  if (on_status_) on_status_(status);
}

void Client::take_acknowledgements(const status_t& status) {
  for (std::size_t i = 0; i < status.ack_request_id.size(); ++i) {
    const std::int64_t id = status.ack_request_id[i];
    if (std::ranges::none_of(pending_,
                             [&](const Pending& p) { return p.request.request_id == id; })) {
      continue;
    }
    abandon(id);
    acknowledgements_.push_front({id, status.ack_code[i], status.ack_text[i], status.session_id});
    if (acknowledgements_.size() > kAcknowledgementsKept) acknowledgements_.pop_back();
  }
}

}  // namespace handeye
