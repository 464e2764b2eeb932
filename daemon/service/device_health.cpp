// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/device_health.hpp"

#include <fmt/format.h>

namespace handeye {
namespace {

constexpr std::int64_t kRateWindow_ns = 2'000'000'000;

std::int32_t state_code(ClockState state) {
  switch (state) {
    case ClockState::kAbsent:
      return clock_status_t::ABSENT;
    case ClockState::kSettling:
      return clock_status_t::SETTLING;
    case ClockState::kSteady:
      return clock_status_t::STEADY;
    case ClockState::kUnstable:
      return clock_status_t::UNSTABLE;
  }
  return clock_status_t::ABSENT;
}

std::string text_of(const ClockReport& report) {
  if (report.state == ClockState::kUnstable) {
    return report.jumps == 0 ? "the clock contradicts the times of arrival; looking again"
                             : "the clock jumps; is its time being set?";
  }
  if (report.state == ClockState::kSettling) return "being found";
  if (report.state == ClockState::kAbsent) return "no time of its own: the arrivals stand for it";
  if (report.backwards > 0) return fmt::format("{} stamps went back", report.backwards);
  return "";
}

}  // namespace

clock_status_t clock_status(const ClockReport& report) {
  clock_status_t status{};
  status.state = state_code(report.state);
  status.text = text_of(report);
  status.drift_ppm = report.drift_ppm;
  status.jitter_ms = report.jitter_ms;
  status.span_s = report.span_s;
  status.jumps = report.jumps;
  status.midnights = report.midnights;
  return status;
}

device_status_t DeviceStatusReporter::report(const DeviceHealth& health, std::int64_t now_ns) {
  device_status_t status{};
  std::tie(status.state, status.text) = health.state();
  status.received = health.received;
  status.dropped = health.dropped;
  status.dropped_queue = health.dropped_queue;
  status.malformed = health.malformed;
  status.restarts = health.restarts;
  status.reordered = health.reordered;
  status.clock = clock_status(health.clock());

  history_.emplace_back(now_ns, status.received);
  while (history_.size() > 2 && now_ns - history_[1].first >= kRateWindow_ns) history_.pop_front();
  const auto [then_ns, received_then] = history_.front();
  if (now_ns > then_ns) {
    status.rate_hz = 1e9 * static_cast<double>(status.received - received_then) /
                     static_cast<double>(now_ns - then_ns);
  }

  const std::int64_t last_ns = health.last_ns;
  if (last_ns == 0) status.clock.text = "nothing has come yet";
  status.age_s = last_ns == 0 ? -1 : 1e-9 * static_cast<double>(now_ns - last_ns);
  if (status.state == device_status_t::STREAMING && status.age_s > silent_after_s_) {
    status.state = device_status_t::SILENT;
    status.text = fmt::format("{}: nothing for {:.1f} s", status.text, status.age_s);
    status.clock.text = fmt::format("nothing for {:.1f} s, this was before", status.age_s);
  }
  return status;
}

}  // namespace handeye
