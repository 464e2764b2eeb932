// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/hand_stream.hpp"

#include <algorithm>

namespace handeye {
namespace {

// One damaged ts line is no new clock; a sender that was set up anew keeps to its new way.
constexpr int kOthersThatSwitch = 20;

}  // namespace

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
  follow_device_clock();
  const std::optional<double> device_s = device_time_s();
  // A datagram without the time that others carry: as late as the one before it.
  if (!device_s) return arrival_ns - lateness_ns_;
  const std::int64_t host_ns = clock_.observe(*device_s, arrival_ns);
  lateness_ns_ = arrival_ns - host_ns;
  return host_ns;
}

void HandStream::follow_device_clock() {
  // ts2 wins over ts (protocol.md section 5).
  const DeviceClock sent = frame_.unix_time        ? DeviceClock::kUnixTime
                           : frame_.seconds_of_day ? DeviceClock::kSecondsOfDay
                                                   : DeviceClock::kNone;
  if (sent == device_clock_) {
    others_in_a_row_ = 0;
    return;
  }
  if (device_clock_ != DeviceClock::kUnknown && ++others_in_a_row_ < kOthersThatSwitch) return;
  clock_ = ClockModel();
  device_clock_ = sent;
  lateness_ns_ = 0;
  others_in_a_row_ = 0;
}

std::optional<double> HandStream::device_time_s() const {
  switch (device_clock_) {
    case DeviceClock::kUnixTime:
      if (!frame_.unix_time) return std::nullopt;
      return frame_.unix_time->seconds + 1e-6 * frame_.unix_time->microseconds;
    case DeviceClock::kSecondsOfDay:
      return frame_.seconds_of_day;
    case DeviceClock::kNone:
    case DeviceClock::kUnknown:
      break;
  }
  return std::nullopt;
}

}  // namespace handeye
