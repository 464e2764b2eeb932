// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/clock_model.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

constexpr double kDay_s = 86400.0;
// So many steady data exonerate a clock that its counter accuses; so many suspects are no accident.
constexpr int kSteady = 3;
// Before these the report says that the mapping, or its slope, is not yet known.
constexpr double kSteadyAfter_s = 2.0;
constexpr double kDriftAfter_s = 10.0;
// Two jumps within this are no accident.
constexpr double kUnstableFor_s = 60.0;
constexpr double kJitterShare = 0.95;

double seconds_from_ns(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

std::int64_t ns_from_seconds(double duration_s) {
  return std::llround(duration_s * 1e9);
}

/// Whether time passes alike on both clocks; data that a stalled network delivers all at once
/// arrive together.
bool arrives_apart(const LowerEnvelope::Point& before, const LowerEnvelope::Point& after) {
  const double device_passed = after.device_s - before.device_s;
  const double arrival_passed = device_passed + after.lateness_s - before.lateness_s;
  return device_passed > 0 && arrival_passed >= 0.5 * device_passed;
}

}  // namespace

ClockModel::ClockModel(const ClockModelOptions& options)
    : options_(options), envelope_(options.window_s, options.max_drift), witness_(options.step_s) {}

ClockReading ClockModel::observe(double device_s, std::int64_t arrival_ns,
                                 std::optional<std::uint32_t> tick) {
  if (!std::isfinite(device_s)) return {arrival_ns, true};
  if (!started_) start(device_s, arrival_ns);

  const double since_origin_s = unwrapped(device_s, arrival_ns) - origin_device_s_;
  const Point point{since_origin_s, seconds_from_ns(arrival_ns - origin_ns_) - since_origin_s};
  if (tick) witness_.observe(since_origin_s + origin_device_s_, *tick);
  const Belief belief = judge(point, tick && witness_.knows());
  if (belief == Belief::kJumped) return jump(device_s, arrival_ns);
  if (belief == Belief::kDoubted) {
    return {std::min(mapped_ns(point.device_s), arrival_ns), true, true};
  }

  const bool window_is_over =
      since_origin_s + origin_device_s_ - last_device_s_ > options_.window_s;
  count_midnights(since_origin_s + origin_device_s_ - device_s);
  if (window_is_over) {  // nothing of it is left after such a pause
    start(device_s, arrival_ns);
    return {arrival_ns, true};
  }
  last_device_s_ = since_origin_s + origin_device_s_;
  last_arrival_ns_ = arrival_ns;
  if (belief == Belief::kBelieved) take(point);
  glide(point.device_s);
  residuals_s_.add(point.lateness_s - envelope_.at(point.device_s));
  const std::int64_t timestamp_ns = mapped_ns(point.device_s);
  const bool doubtful = !settled_ || std::abs(correction_s_) > options_.doubtful_s;
  if (doubtful) return {std::min(timestamp_ns, arrival_ns), true};
  return {.timestamp_ns = timestamp_ns, .mapping = mapping_at(point.device_s)};
}

std::int64_t ClockModel::mapped_ns(double device_s) const {
  return origin_ns_ + ns_from_seconds(device_s + envelope_.at(device_s) + correction_s_);
}

ClockMapping ClockModel::mapping_at(double device_s) const {
  return {.device_ns = origin_ns_ + ns_from_seconds(device_s),
          .lateness_ns = ns_from_seconds(envelope_.at(device_s)),
          .slope = envelope_.slope(),
          .run = runs_};
}

/// The seconds of the day, counted on from the last observation's day: the day is the one that the
/// host's clock expects, so midnight is found after any pause.
double ClockModel::unwrapped(double device_s, std::int64_t arrival_ns) const {
  const double expected = last_device_s_ + seconds_from_ns(arrival_ns - last_arrival_ns_);
  return device_s + kDay_s * std::round((expected - device_s) / kDay_s);
}

/// A day begins once, whatever comes late around midnight.
void ClockModel::count_midnights(double days_passed_s) {
  const auto day = static_cast<std::int64_t>(std::round(days_passed_s / kDay_s));
  midnights_ += std::max<std::int64_t>(0, day - day_);
  day_ = std::max(day, day_);
}

void ClockModel::start(double device_s, std::int64_t arrival_ns) {
  started_ = true;
  ++runs_;
  origin_ns_ = last_arrival_ns_ = arrival_ns;
  origin_device_s_ = last_device_s_ = device_s;
  envelope_.clear();
  envelope_.insert({});
  witness_.reset();
  residuals_s_.clear();
  correction_s_ = corrected_at_s_ = 0;
  settled_ = false;
  earliest_ = last_near_ = {};
  near_earliest_ = suspects_ = 0;
  day_ = 0;
}

ClockReading ClockModel::jump(double device_s, std::int64_t arrival_ns) {
  ++jumps_;
  before_last_jump_ns_ = last_jump_ns_;
  last_jump_ns_ = arrival_ns;
  start(device_s, arrival_ns);
  return {arrival_ns, true, true};
}

ClockModel::Belief ClockModel::judge(const Point& point, bool witnessed) {
  const double residual_s = point.lateness_s - envelope_.at(point.device_s);
  if (witnessed && witness_.stepped_s() != 0) return judge_step(point, residual_s);
  if (std::abs(residual_s) <= believable_s(point.device_s) || (witnessed && options_.lenient)) {
    suspects_ = 0;
    return Belief::kBelieved;
  }
  // Nothing arrives before it was sent: that the mapping was late needs no confirmation.
  if (witnessed && residual_s < 0) return Belief::kJumped;
  const bool is_steady = runs_on(point);
  const bool may_be_delay = witnessed || (options_.lenient && residual_s > 0);
  const int needed = may_be_delay ? options_.delay_confirmations : options_.jump_confirmations;
  if (suspects_ >= needed) return Belief::kJumped;
  // A late datum whose clock is vouched for is only late, until the next is as late at the pace of
  // both clocks: then the host's clock may have been stepped. Nothing tells so of the first one.
  return witnessed && !is_steady ? Belief::kLate : Belief::kDoubted;
}

/// The counter says that the clock was stepped. So does the lateness, or the counter was: it began
/// anew, or does not count what the clock counts.
ClockModel::Belief ClockModel::judge_step(const Point& point, double residual_s) {
  runs_on(point);
  const bool is_on_time = std::abs(residual_s) < 0.5 * std::abs(witness_.stepped_s()) &&
                          std::abs(residual_s) <= believable_s(point.device_s);
  if (is_on_time && (suspects_ >= kSteady || options_.lenient)) {
    witness_.reset();
    suspects_ = 0;
    return Belief::kBelieved;
  }
  if (!is_on_time && suspects_ >= options_.jump_confirmations) return Belief::kJumped;
  return Belief::kDoubted;
}

/// Counts the data in a row that are as late as each other while both clocks run on.
bool ClockModel::runs_on(const Point& suspect) {
  const bool goes_on =
      suspects_ > 0 &&
      std::abs(suspect.lateness_s - first_suspect_.lateness_s) <= 0.5 * options_.jump_s &&
      arrives_apart(first_suspect_, suspect);
  if (!goes_on) {
    first_suspect_ = suspect;
    suspects_ = 0;
  }
  ++suspects_;
  return goes_on;
}

/// How far from the mapping a stamp may lie: a jump's size, and after a pause what drift explains.
double ClockModel::believable_s(double device_s) const {
  const double pause_s = std::abs(device_s - (last_device_s_ - origin_device_s_));
  return options_.jump_s + 2.0 * options_.max_drift * pause_s;
}

void ClockModel::take(const Point& point) {
  const double before_s = envelope_.at(point.device_s) + correction_s_;
  if (envelope_.insert(point) && settled_) {
    correction_s_ = before_s - envelope_.at(point.device_s);
  }
  if (!settled_) settle(point);
}

/// A mapping that rests on the first data alone would be as late as they are: those that a stalled
/// network delivers at once are late by ever less.
void ClockModel::settle(const Point& point) {
  if (point.lateness_s < earliest_.lateness_s - options_.settling_spread_s) {
    near_earliest_ = 0;
  } else if (point.lateness_s <= earliest_.lateness_s + options_.settling_spread_s &&
             (near_earliest_ == 0 || arrives_apart(last_near_, point))) {
    ++near_earliest_;
    last_near_ = point;
  }
  if (near_earliest_ == 0) {
    near_earliest_ = 1;
    last_near_ = point;
  }
  if (point.lateness_s < earliest_.lateness_s) earliest_ = point;
  settled_ =
      near_earliest_ >= options_.settling_data || point.device_s > options_.settling_at_most_s;
}

/// The envelope steps when a lower point comes or an old one leaves. A step in the stamps would be
/// a jerk of the hand, so the mapping glides; by at most half of the time passed, that it never
/// runs backwards.
void ClockModel::glide(double device_s) {
  const double passed = std::max(0.0, device_s - corrected_at_s_);
  corrected_at_s_ = std::max(corrected_at_s_, device_s);
  const double wanted = correction_s_ * -std::expm1(-passed / options_.gliding_s);
  correction_s_ -= std::clamp(wanted, -0.5 * passed, 0.5 * passed);
}

double ClockModel::lateness_s() const {
  const double since_origin_s = last_device_s_ - origin_device_s_;
  return seconds_from_ns(origin_ns_) - origin_device_s_ + envelope_.at(since_origin_s);
}

ClockReport ClockModel::report() const {
  ClockReport report;
  report.jumps = jumps_;
  report.midnights = midnights_;
  if (!started_) return report;
  report.span_s = seconds_from_ns(last_arrival_ns_ - origin_ns_);
  if (report.span_s >= kDriftAfter_s) report.drift_ppm = 1e6 * drift();
  report.jitter_ms = 1e3 * std::max(0.0, residuals_s_.at(kJitterShare));
  const bool jumps_often =
      seconds_from_ns(last_arrival_ns_ - before_last_jump_ns_) < kUnstableFor_s;
  if (jumps_often || suspects_ >= kSteady) {
    report.state = ClockState::kUnstable;
  } else if (!settled_ || report.span_s < kSteadyAfter_s) {
    report.state = ClockState::kSettling;
  } else {
    report.state = ClockState::kSteady;
  }
  return report;
}

}  // namespace handeye
