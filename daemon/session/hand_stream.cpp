// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/hand_stream.hpp"

#include <algorithm>

#include "daemon/session/body_covariance.hpp"

namespace handeye {
namespace {

// One damaged ts line is no new clock; a sender that was set up anew keeps to its new way.
constexpr int kOthersThatSwitch = 20;

}  // namespace

std::optional<HandSample> HandStream::take(const Datagram& datagram) {
  if (parser_.parse(datagram.bytes, frame_) == dtrack::ParseStatus::kRejected) return std::nullopt;
  stamp(datagram.arrival_ns);
  if (body_id_ < 0) {
    const auto seen = std::ranges::find_if(frame_.bodies, &dtrack::Body::tracked);
    if (seen != frame_.bodies.end()) body_id_ = seen->id;
  }
  HandSample sample = sample_of(body_id_);
  const dtrack::Body* body = frame_.find_body(body_id_);
  const bool said = body != nullptr && body->tracked && covariance_said_of(body_id_) != nullptr;
  if (said && !sample.covariance) ++bad_covariances_;
  return sample;
}

HandSample HandStream::sample_of(int body_id) const {
  HandSample sample = time_;
  const dtrack::Body* body = frame_.find_body(body_id);
  if (body == nullptr || !body->tracked) return sample;
  sample.tracked = !sample.doubtful_time;
  sample.room_from_hand = body->room_from_body;
  const dtrack::BodyCovariance* said = covariance_said_of(body_id);
  if (said != nullptr) sample.covariance = covariance_of_body(*said, body->room_from_body);
  return sample;
}

const dtrack::BodyCovariance* HandStream::covariance_said_of(int body_id) const {
  const auto said = std::ranges::find(frame_.covariances, body_id, &dtrack::BodyCovariance::id);
  return said == frame_.covariances.end() ? nullptr : &*said;
}

void HandStream::stamp(std::int64_t arrival_ns) {
  follow_device_clock();
  time_ = {};
  const std::optional<double> device_s = device_time_s();
  if (device_s) {
    const ClockReading reading = clock_.observe(*device_s, arrival_ns, frame_.number);
    time_.timestamp_ns = reading.timestamp_ns;
    time_.doubtful_time = reading.doubtful;
    if (!reading.doubtful) time_.clock_mapping = reading.mapping;
    lateness_ns_ = arrival_ns - reading.timestamp_ns;
  } else {
    // A datagram without the time that others carry: as late as the one before it.
    time_.timestamp_ns = arrival_ns - lateness_ns_;
    time_.doubtful_time = device_clock_ != DeviceClock::kNone;
  }
  time_.clock_epoch = first_epoch_ + clock_.epoch();
}

ClockReport HandStream::clock_report() const {
  ClockReport report = clock_.report();
  report.jumps += first_epoch_;
  report.midnights += midnights_before_;
  return report;
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
  if (device_clock_ != DeviceClock::kUnknown) {
    const ClockReport before = clock_report();
    first_epoch_ = static_cast<std::int32_t>(before.jumps) + 1;
    midnights_before_ = before.midnights;
  }
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
