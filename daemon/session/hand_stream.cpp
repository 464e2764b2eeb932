// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/hand_stream.hpp"

#include <algorithm>

namespace handeye {

std::optional<HandSample> HandStream::take(const Datagram& datagram) {
  if (parser_.parse(datagram.bytes, frame_) == dtrack::ParseStatus::kRejected) return std::nullopt;
  const std::int64_t timestamp_ns = host_time_ns(datagram.arrival_ns);
  if (body_id_ < 0) {
    const auto seen = std::ranges::find_if(frame_.bodies, &dtrack::Body::tracked);
    if (seen != frame_.bodies.end()) body_id_ = seen->id;
  }
  return sample_of(body_id_, timestamp_ns);
}

HandSample HandStream::sample_of(int body_id, std::int64_t timestamp_ns) const {
  HandSample sample;
  sample.timestamp_ns = timestamp_ns;
  const dtrack::Body* body = frame_.find_body(body_id);
  if (body != nullptr && body->tracked) {
    sample.tracked = true;
    sample.room_from_hand = body->room_from_body;
  }
  return sample;
}

std::int64_t HandStream::host_time_ns(std::int64_t arrival_ns) {
  // ts2 wins over ts (protocol.md section 5).
  const DeviceClock now = frame_.unix_time        ? DeviceClock::kUnixTime
                          : frame_.seconds_of_day ? DeviceClock::kSecondsOfDay
                                                  : DeviceClock::kNone;
  if (now != device_clock_) {
    clock_ = ClockModel();
    device_clock_ = now;
  }
  switch (now) {
    case DeviceClock::kUnixTime:
      return clock_.observe(frame_.unix_time->seconds + 1e-6 * frame_.unix_time->microseconds,
                            arrival_ns);
    case DeviceClock::kSecondsOfDay:
      return clock_.observe(*frame_.seconds_of_day, arrival_ns);
    case DeviceClock::kNone:
    case DeviceClock::kUnknown:
      break;
  }
  return arrival_ns;
}

}  // namespace handeye
