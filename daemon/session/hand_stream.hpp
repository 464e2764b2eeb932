// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/sync/clock_model.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "drivers/datagram.hpp"
#include "drivers/dtrack/parser.hpp"

namespace handeye {

/// From the tracker's datagrams to samples of the hand on the host's clock: parser, then clock
/// model. The same in the live daemon and in a replay. One thread.
class HandStream {
 public:
  /// `body_id`: the body on the scope, the wire's number; -1: the first body that is seen tracked.
  explicit HandStream(int body_id) : body_id_(body_id) {}

  /// Nothing when the datagram was rejected. A body that is absent is hidden: `tracked` is false.
  /// From a sender that sends no device time (no ts, no ts2) the arrival stands for it; a single
  /// datagram that lacks it is taken to be as late as the one before, and its time is doubtful. A
  /// sample of doubtful time is not tracked. Datagrams that were overtaken on the way come late.
  std::optional<HandSample> take(const Datagram& datagram);

  /// Another body of the last datagram, as a sample with the time of the last one taken.
  HandSample sample_of(int body_id) const;

  /// What the last datagram said; empty after a rejected one.
  const dtrack::Frame& frame() const { return frame_; }
  const dtrack::ParseCounters& counters() const { return parser_.counters(); }
  /// The tracker's clock, whichever of its clocks is used. A few microseconds.
  ClockReport clock_report() const;
  /// Covariances (6dcov) that could not be meant, and were left out.
  std::uint64_t bad_covariances() const { return bad_covariances_; }
  /// -1 as long as no body has been seen.
  int body_id() const { return body_id_; }
  void set_body_id(int body_id) { body_id_ = body_id; }

 private:
  enum class DeviceClock { kUnknown, kNone, kSecondsOfDay, kUnixTime };

  void stamp(std::int64_t arrival_ns);
  const dtrack::BodyCovariance* covariance_said_of(int body_id) const;
  void follow_device_clock();
  std::optional<double> device_time_s() const;

  int body_id_;
  dtrack::Parser parser_;
  dtrack::Frame frame_;
  ClockModel clock_;
  DeviceClock device_clock_{DeviceClock::kUnknown};
  int others_in_a_row_{0};       ///< datagrams whose time is of another kind, or missing
  std::int64_t lateness_ns_{0};  ///< arrival minus host time of the last that had a time
  HandSample time_;              ///< of the last datagram: only what concerns time
  std::int32_t first_epoch_{0};  ///< of clock_: those before belong to the clocks before
  std::int64_t midnights_before_{0};
  std::uint64_t bad_covariances_{0};
};

}  // namespace handeye
