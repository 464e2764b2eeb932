// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/service/heartbeat.hpp"

namespace handeye {

/// Listens to the threads' heartbeats. Silence counts only while the monitor itself is called: a
/// process that was stopped, or a machine that slept, finds nobody stuck when it goes on. One
/// thread.
class HeartMonitor {
 public:
  /// `longest_silence_s`: a thread that is silent for longer is stuck. `heartbeat` must outlive the
  /// monitor.
  void add(std::string name, const Heartbeat& heartbeat, double longest_silence_s);

  /// Listens; to be called several times a second. Logs who became stuck, and who goes on. True:
  /// nobody is stuck. `now_ns`: CLOCK_MONOTONIC.
  bool check(std::int64_t now_ns);

  /// Names, in the order of add().
  std::vector<std::string> stuck() const;

 private:
  struct Patient {
    std::string name;
    const Heartbeat* heartbeat{nullptr};
    std::int64_t longest_silence_ns{0};
    std::uint64_t beats{0};
    std::int64_t silent_ns{0};
    bool stuck{false};
  };
  static void listen(Patient& patient, std::int64_t elapsed_ns);

  std::vector<Patient> patients_;
  std::int64_t checked_ns_{0};
};

}  // namespace handeye
