// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <handeye/request_t.hpp>
#include <handeye/result_t.hpp>
#include <handeye/status_t.hpp>

#include "protocol/channels.hpp"

/// libhandeye-client: asks handeyed for a calibration over LCM, as reliably as LCM allows.
namespace handeye {

class Bus;
template <typename Message>
class Publisher;

/// How to reach the daemon.
struct ClientOptions {
  std::string lcm_url{kDefaultLcmProvider};
  std::string channel_prefix{kDefaultChannelPrefix};
  /// A request is sent again at this period until STATUS acknowledges it.
  std::chrono::milliseconds request_period{250};
};

/// What a START asks for. What is left at its default is decided by the daemon's configuration.
struct StartRequest {
  int body_id{-1};                        ///< the wire's number, from 0; -1: the configured body
  double wanted_sigma_rotation_deg{0};    ///< accept at or below; <= 0: the configured one
  double wanted_sigma_translation_mm{0};  ///< accept at or below; <= 0: the configured one
  std::string board;  ///< the eye's poses from this board, as request_t says; empty: from the scene
  double max_duration_s{0};  ///< give up collecting after this; <= 0: the configured one
};

/// What became of a request, as STATUS told it.
struct Acknowledgement {
  std::int64_t request_id{0};
  std::int32_t code{status_t::ACK_TAKEN};  ///< one of status_t's ACK constants
  std::string text;                        ///< why it was not taken, in one line; empty when taken
  std::int64_t daemon_session_id{0};       ///< of the daemon that acknowledged

  bool taken() const { return code == status_t::ACK_TAKEN; }
};

/// One connection to the daemon. Every request is repeated until STATUS carries its id, so a lost
/// message costs a quarter of a second, and the daemon acts on each id once, so a repetition does
/// no harm. Nothing runs in the background for the caller: messages are handled, and requests
/// repeated, only within spin_once().
///
/// Threads: an object belongs to one thread at a time.
class Client {
 public:
  using StatusHandler = std::function<void(const status_t&)>;
  using ResultHandler = std::function<void(const result_t&)>;

  /// Connects and listens. Throws InputError when LCM cannot be used (no multicast route, bad URL)
  /// and UsageError for a prefix that LCM could not carry.
  explicit Client(const ClientOptions& options = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Each sends a request, keeps it repeated, and returns its request_id at once.
  /// target_request_id: the calibration meant; 0: whichever runs.
  std::int64_t start(const StartRequest& wanted);
  std::int64_t finish(std::int64_t target_request_id = 0);
  std::int64_t cancel(std::int64_t target_request_id = 0);
  /// Asks for the last RESULT again.
  std::int64_t describe();
  /// Asks the daemon to publish DATAGRAM, and FRAME of its own camera, for duration_s from now.
  std::int64_t record(double duration_s);

  /// Stops repeating a request, but still takes its acknowledgement when the daemon has heard it.
  void stop_repeating(std::int64_t request_id);

  /// Stops repeating a request and listening for its acknowledgement. What the daemon has already
  /// heard of it stands.
  void abandon(std::int64_t request_id);

  /// Nothing as long as no STATUS carried the id. The last 64 are remembered.
  std::optional<Acknowledgement> acknowledgement(std::int64_t request_id) const;

  /// Called from within spin_once() with every STATUS, after its acknowledgements were taken in,
  /// and every RESULT, whoever asked for it. One handler each: a later one replaces the earlier.
  /// A handler must not throw: LCM's C code stands between it and the caller of spin_once().
  void on_status(StatusHandler handler) { on_status_ = std::move(handler); }
  void on_result(ResultHandler handler) { on_result_ = std::move(handler); }

  /// Repeats what is due, waits at most `timeout` for one message and handles it.
  /// True: a message was handled, there may be more.
  bool spin_once(std::chrono::milliseconds timeout);

  /// For an event loop: readable when a message waits; then, and after next_send_in() at the
  /// latest, call spin_once(0 ms) until it returns false.
  int file_descriptor() const;

  /// Time until a request is due to be repeated; nothing: none is pending.
  std::optional<std::chrono::milliseconds> next_send_in() const;

  /// The newest STATUS; nothing: none heard yet.
  const std::optional<status_t>& last_status() const { return last_status_; }

  /// Messages on STATUS and RESULT that were of another type: a daemon of another version.
  std::uint64_t undecodable() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Pending {
    request_t request;
    std::optional<Clock::time_point> due;  ///< nothing: not to be repeated
  };

  std::int64_t send(request_t request);
  void send_due();
  void take_status(const status_t& status);
  void take_acknowledgements(const status_t& status);

  std::chrono::milliseconds request_period_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Publisher<request_t>> requests_;
  std::vector<Pending> pending_;
  std::deque<Acknowledgement> acknowledgements_;
  std::optional<status_t> last_status_;
  StatusHandler on_status_;
  ResultHandler on_result_;
};

}  // namespace handeye
