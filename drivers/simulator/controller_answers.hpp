// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <string_view>

namespace handeye::simulator {

/// How a simulated controller misbehaves. Without any it does as DTrack does.
enum class ControllerFault {
  kRefuse,   ///< closes every connection at once
  kSlow,     ///< answers byte by byte, four a second
  kGarbage,  ///< answers, but not as DTrack does
  kError,    ///< answers every command with an error
  kSilent,   ///< takes commands and never answers
  kBusy,     ///< another program is connected already and has the control
};

inline constexpr std::array<std::string_view, 6> kControllerFaultNames{
    "refuse", "slow", "garbage", "error", "silent", "busy"};

std::optional<ControllerFault> controller_fault_from_name(std::string_view name);

/// What a controller knows and says: tracking or not, and an answer to each command it hears.
class ControllerAnswers {
 public:
  /// `owner`: who has the control where it is not the one who asks.
  std::string answer(std::string_view command, bool full_access, std::string_view owner);

  /// From any thread.
  bool tracking() const { return tracking_; }

 private:
  std::string start_or_stop(bool start);

  std::atomic<bool> tracking_{false};
};

}  // namespace handeye::simulator
