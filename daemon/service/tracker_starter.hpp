// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "daemon/config/config.hpp"
#include "daemon/service/start_policy.hpp"

namespace handeye {

/// Asks the tracker's controller to track while nothing comes from it, in a thread of its own, for
/// the controller may take its time. Everything it does is in the log.
///
/// Stops the tracking in the end if, and only if, it has started it.
class TrackerStarter {
 public:
  /// `last_packet_ns`: CLOCK_MONOTONIC of the tracker's newest packet, 0: none yet; called from the
  /// starter's thread. Does nothing before start().
  TrackerStarter(const Config::Tracker& config, std::function<std::int64_t()> last_packet_ns,
                 const StartPolicyOptions& options = {});
  /// Takes up to 2 s where tracking is to be stopped and the controller does not answer.
  ~TrackerStarter() = default;
  TrackerStarter(const TrackerStarter&) = delete;
  TrackerStarter& operator=(const TrackerStarter&) = delete;

  void start();

  /// For STATUS, from any thread: how the last attempt went, one line. Empty: there was none, or
  /// packets have come since.
  std::string text() const;

 private:
  void run(const std::stop_token& stop);
  void ask(StartPolicy& policy, const std::stop_token& stop);
  void stop_tracking(const StartPolicy& policy);
  void say(const std::string& text);

  dtrack::CommandOptions command_;
  std::function<std::int64_t()> last_packet_ns_;
  StartPolicyOptions options_;
  std::string logged_;  ///< the same failure is not logged over and over

  mutable std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::string text_;
  std::int64_t told_ns_{0};  ///< when text_ was set
  std::jthread thread_;
};

}  // namespace handeye
