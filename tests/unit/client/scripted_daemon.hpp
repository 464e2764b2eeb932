// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <handeye/request_t.hpp>
#include <handeye/result_t.hpp>
#include <handeye/status_t.hpp>

#include "protocol/bus.hpp"
#include "protocol/channels.hpp"

namespace handeye::test {

/// A LCM provider on this machine with a port of its own, so that tests running at the same time
/// do not hear each other.
std::string private_provider();

/// Why LCM cannot be used here; nothing: it can. For GTEST_SKIP.
std::optional<std::string> lcm_problem();

/// Messages with every field set to something harmless.
status_t idle_status();
result_t result_message(std::int64_t request_id, std::int32_t verdict);

/// The daemon's side of the protocol over real LCM, in a thread: STATUS every 20 ms, and what the
/// test's script does with every request. It keeps an account of what it heard.
class ScriptedDaemon {
 public:
  /// Called with every request, also repeated ones, in the daemon's thread; may change the status
  /// to publish from now on, acknowledge, and send results.
  using Script = std::function<void(ScriptedDaemon&, const request_t&)>;

  ScriptedDaemon(const std::string& provider, Script script);
  ~ScriptedDaemon();
  ScriptedDaemon(const ScriptedDaemon&) = delete;
  ScriptedDaemon& operator=(const ScriptedDaemon&) = delete;

  // For the script, in the daemon's thread.
  status_t& status() { return status_; }
  void acknowledge(const request_t& request, std::int32_t code = status_t::ACK_TAKEN,
                   const std::string& text = "");
  void send_result(result_t result);
  /// How often a request with this id has come, this one included.
  int times_heard(std::int64_t request_id) const;

  // For the test, from its thread.
  std::vector<request_t> requests() const;
  /// Ids of the requests with this action, each once, in order of arrival.
  std::vector<std::int64_t> distinct_ids(std::int32_t action) const;

 private:
  void run();
  void take(const request_t& request);

  Bus bus_;
  Channels channels_;
  Publisher<status_t> statuses_;
  Publisher<result_t> results_;
  Script script_;
  status_t status_;
  mutable std::mutex mutex_;  ///< guards requests_
  std::vector<request_t> requests_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace handeye::test
