// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/heart_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "daemon/service/journal.hpp"

namespace handeye {
namespace {

// What one call may add to a silence: more than the calls are apart, less than any limit.
constexpr std::int64_t kLargestStep_ns = 400'000'000;

}  // namespace

void HeartMonitor::add(std::string name, const Heartbeat& heartbeat, double longest_silence_s) {
  patients_.push_back({.name = std::move(name),
                       .heartbeat = &heartbeat,
                       .longest_silence_ns = std::llround(1e9 * longest_silence_s),
                       .beats = heartbeat.beats()});
}

bool HeartMonitor::check(std::int64_t now_ns) {
  const std::int64_t elapsed_ns =
      checked_ns_ == 0 ? 0 : std::min(now_ns - checked_ns_, kLargestStep_ns);
  checked_ns_ = now_ns;
  for (Patient& patient : patients_) listen(patient, elapsed_ns);
  return std::ranges::none_of(patients_, &Patient::stuck);
}

void HeartMonitor::listen(Patient& patient, std::int64_t elapsed_ns) {
  const std::uint64_t beats = patient.heartbeat->beats();
  const bool alive = patient.heartbeat->resting() || beats != patient.beats;
  patient.beats = beats;
  patient.silent_ns = alive ? 0 : patient.silent_ns + elapsed_ns;
  const bool stuck = patient.silent_ns > patient.longest_silence_ns;
  if (std::exchange(patient.stuck, stuck) == stuck) return;
  if (stuck) {
    log_event(
        Event::kThreadStuck,
        fmt::format("the {} thread has made no progress for {:.1f} s: the watchdog is not fed",
                    patient.name, 1e-9 * static_cast<double>(patient.silent_ns)),
        {{"THREAD", patient.name}});
  } else {
    log_event(Event::kThreadGoesOn, fmt::format("the {} thread goes on", patient.name),
              {{"THREAD", patient.name}});
  }
}

std::vector<std::string> HeartMonitor::stuck() const {
  std::vector<std::string> names;
  for (const Patient& patient : patients_) {
    if (patient.stuck) names.push_back(patient.name);
  }
  return names;
}

}  // namespace handeye
