// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace handeye::test {

/// Stands where systemd stands: NOTIFY_SOCKET, and WATCHDOG_USEC if wanted, of the programs that
/// are started while it lives are its own.
class Notifications {
 public:
  /// `socket`: a path that does not exist yet. `watchdog`: 0: none.
  explicit Notifications(const std::filesystem::path& socket,
                         std::chrono::microseconds watchdog = std::chrono::microseconds(0));
  ~Notifications();
  Notifications(const Notifications&) = delete;
  Notifications& operator=(const Notifications&) = delete;

  /// Every line heard so far, in order: "READY=1".
  const std::vector<std::string>& lines();
  /// How many of them begin so.
  int count(std::string_view beginning);
  void forget();

 private:
  int descriptor_;
  std::vector<std::string> lines_;
};

}  // namespace handeye::test
