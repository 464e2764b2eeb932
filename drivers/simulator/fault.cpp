// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/fault.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "drivers/simulator/mixed_bits.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

struct Kind {
  FaultKind kind;
  std::string_view name;
  bool once;
  double usual, least, most;  ///< amount
  std::string_view help;
};

constexpr std::array<Kind, 6> kTrackerKinds{{
    {FaultKind::kOcclusion, "occlusion", true, 2.0, 0.01, 600, "the body is hidden [s]"},
    {FaultKind::kLost, "lost", false, 0.08, 0, 1, "share of the datagrams that get lost"},
    {FaultKind::kReordered, "reordered", false, 0.08, 0, 1, "share that the next one overtakes"},
    {FaultKind::kDuplicated, "duplicated", false, 0.08, 0, 1, "share that arrives twice"},
    {FaultKind::kBursts, "bursts", false, 0.2, 0.01, 1.5,
     "every 2 s held back so long [s], then at once"},
    {FaultKind::kClockJump, "clock-jump", true, 0.3, -43200, 43200,
     "the tracker's clock goes forward, or back [s]"},
}};

constexpr std::array<Kind, 2> kCameraKinds{{
    {FaultKind::kStall, "stall", true, 0.5, 0.01, 600,
     "no frames [s], then up to four that were held back; the rest is lost"},
    {FaultKind::kStampJump, "stamp-jump", true, 0.3, -3600, 3600,
     "the time stamps go forward, or back [s]"},
}};

constexpr std::uint64_t kTimes = 0x6661756c74;  // distinguishes the drawing
constexpr double kEarliest_s = 3.0;
constexpr double kLatest_s = 7.0;

const Kind& kind_of(FaultKind kind) {
  const auto* const of_tracker = std::ranges::find(kTrackerKinds, kind, &Kind::kind);
  return of_tracker != kTrackerKinds.end() ? *of_tracker
                                           : *std::ranges::find(kCameraKinds, kind, &Kind::kind);
}

double number_in(std::string_view number, std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(value)) {
    throw UsageError(fmt::format(
        "disturbance '{}': '{}' is no number; write NAME[@SECONDS][=AMOUNT]", text, number));
  }
  return value;
}

std::string names_of(std::span<const Kind> kinds) {
  std::string names;
  for (const Kind& kind : kinds) names += fmt::format("{}{}", names.empty() ? "" : ", ", kind.name);
  return names;
}

Fault fault_of(std::span<const Kind> kinds, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view before = text.substr(0, equals);
  const std::size_t at = before.find('@');
  const auto kind = std::ranges::find(kinds, before.substr(0, at), &Kind::name);
  if (kind == kinds.end()) {
    throw UsageError(
        fmt::format("disturbance '{}': unknown; choose one of {}", text, names_of(kinds)));
  }
  Fault fault{.kind = kind->kind, .at_s = {}, .amount = kind->usual};
  if (at != std::string_view::npos) {
    if (!kind->once) {
      throw UsageError(
          fmt::format("disturbance '{}': goes on all along; leave out the time", text));
    }
    fault.at_s = number_in(before.substr(at + 1), text);
  }
  if (equals != std::string_view::npos) fault.amount = number_in(text.substr(equals + 1), text);
  if (fault.amount < kind->least || fault.amount > kind->most) {
    throw UsageError(fmt::format("disturbance '{}': the amount goes from {} to {}", text,
                                 kind->least, kind->most));
  }
  return fault;
}

std::string help_of(std::span<const Kind> kinds) {
  std::string text = "NAME[@SECONDS][=AMOUNT],... of";
  for (const Kind& kind : kinds) {
    text += fmt::format("\n{}{}: {}; {} by default", kind.name, kind.once ? "[@SECONDS]" : "",
                        kind.help, kind.usual);
  }
  return text + "\nWithout SECONDS the time is drawn, 3 to 7 s";
}

}  // namespace

bool happens_once(FaultKind kind) {
  return kind_of(kind).once;
}

Fault tracker_fault(std::string_view text) {
  return fault_of(kTrackerKinds, text);
}

Fault camera_fault(std::string_view text) {
  return fault_of(kCameraKinds, text);
}

std::string tracker_fault_help() {
  return help_of(kTrackerKinds);
}

std::string camera_fault_help() {
  return help_of(kCameraKinds);
}

std::string spelling(std::span<const Fault> faults) {
  std::string text;
  for (const Fault& fault : faults) {
    text += fmt::format("{}{}{}={}", text.empty() ? "" : ",", kind_of(fault.kind).name,
                        fault.at_s ? fmt::format("@{:.6g}", *fault.at_s) : "", fault.amount);
  }
  return text.empty() ? "none" : text;
}

std::vector<Fault> with_times(std::span<const Fault> faults, std::uint64_t seed) {
  std::vector<Fault> timed(faults.begin(), faults.end());
  for (std::size_t i = 0; i < timed.size(); ++i) {
    if (timed[i].at_s || !happens_once(timed[i].kind)) continue;
    timed[i].at_s = std::lerp(kEarliest_s, kLatest_s, mixed_fraction(seed ^ kTimes, i));
  }
  return timed;
}

double share_of(std::span<const Fault> faults, FaultKind kind) {
  double share = 0;
  for (const Fault& fault : faults) {
    if (fault.kind == kind) share = fault.amount;
  }
  return share;
}

std::optional<double> interval_end_s(std::span<const Fault> faults, FaultKind kind, double time_s) {
  std::optional<double> end_s;
  for (const Fault& fault : faults) {
    if (fault.kind != kind || time_s < *fault.at_s) continue;
    const double until_s = *fault.at_s + fault.amount;
    if (time_s < until_s) end_s = std::max(end_s.value_or(until_s), until_s);
  }
  return end_s;
}

double sum_until(std::span<const Fault> faults, FaultKind kind, double time_s) {
  double sum = 0;
  for (const Fault& fault : faults) {
    if (fault.kind == kind && time_s >= *fault.at_s) sum += fault.amount;
  }
  return sum;
}

}  // namespace handeye::simulator
