// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace handeye::simulator {

/// What goes wrong with a device's time and with the way of its data to us. (What makes the
/// pictures themselves harder: disturbance.hpp.)
enum class FaultKind {
  // Of the tracker.
  kOcclusion,   ///< once: the body is hidden for so many seconds
  kLost,        ///< all along: this share of the datagrams never arrives
  kReordered,   ///< all along: this share arrives after the one that follows it
  kDuplicated,  ///< all along: this share arrives twice
  kBursts,      ///< every two seconds: held back for so many seconds, then at once
  kClockJump,   ///< once: the tracker's clock goes forward by so many seconds, or back
  // Of the camera.
  kStall,      ///< once: nothing arrives for so many seconds; then a few frames that were held back
  kStampJump,  ///< once: the grabber's stamps go forward by so many seconds, or back
};

struct Fault {
  FaultKind kind;
  std::optional<double> at_s;  ///< simulated time it happens at; nothing: drawn from the seed
  double amount{0};            ///< seconds, or a share of 1

  bool operator==(const Fault&) const = default;
};

/// Whether it happens once, at a time.
bool happens_once(FaultKind kind);

/// Reads NAME[@SECONDS][=AMOUNT]: "occlusion", "lost=0.2", "clock-jump@10=-0.3". Throws UsageError,
/// one line, when there is no such fault of the tracker, or of the camera, when the amount is out
/// of its range, or when there is a time for what happens all along.
Fault tracker_fault(std::string_view text);
Fault camera_fault(std::string_view text);

/// One line for each, for --help.
std::string tracker_fault_help();
std::string camera_fault_help();

/// The same spelling again, separated by commas; "none".
std::string spelling(std::span<const Fault> faults);

/// Gives a time to those that happen once and have none: 3 to 7 s, drawn from the seed.
std::vector<Fault> with_times(std::span<const Fault> faults, std::uint64_t seed);

/// The share of the last fault of a kind; 0 where there is none.
double share_of(std::span<const Fault> faults, FaultKind kind);

/// When the interval of length `amount` ends that a time lies in, begun by a fault that happens
/// once. All must have a time.
std::optional<double> interval_end_s(std::span<const Fault> faults, FaultKind kind, double time_s);

/// Sum of the amounts of those that have happened by then. All must have a time.
double sum_until(std::span<const Fault> faults, FaultKind kind, double time_s);

}  // namespace handeye::simulator
