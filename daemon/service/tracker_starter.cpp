// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/tracker_starter.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/service/thread_role.hpp"
#include "protocol/bus.hpp"

namespace handeye {
namespace {

using dtrack::CommandOutcome;
using std::chrono::milliseconds;

// Five times a second is soon enough for what takes seconds.
constexpr milliseconds kLook{200};
// Whoever stops the daemon waits for it.
constexpr milliseconds kPartingTimeout{2'000};

bool has_succeeded(CommandOutcome outcome) {
  return outcome == CommandOutcome::kDone || outcome == CommandOutcome::kAlready;
}

/// What is to be done where the controller tracks, and yet nothing comes.
constexpr const char* kNoPackets =
    "no packets come: check the output it is set to, and the firewall";

}  // namespace

TrackerStarter::TrackerStarter(const Config::Tracker& config,
                               std::function<std::int64_t()> last_packet_ns,
                               const StartPolicyOptions& options)
    : command_{.controller = config.controller, .port = config.command_port},
      last_packet_ns_(std::move(last_packet_ns)),
      options_(options) {}

void TrackerStarter::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    take_role({.name = "starter"});
    run(stop);
  });
}

void TrackerStarter::run(const std::stop_token& stop) {
  StartPolicy policy(monotonic_ns(), options_);
  while (!stop.stop_requested()) {
    if (policy.is_due(monotonic_ns(), last_packet_ns_())) ask(policy, stop);
    std::unique_lock lock(mutex_);
    stopped_.wait_for(lock, stop, kLook, [] { return false; });
  }
  stop_tracking(policy);
}

void TrackerStarter::ask(StartPolicy& policy, const std::stop_token& stop) {
  const dtrack::CommandReport report = dtrack::start_tracking(command_, stop);
  const std::int64_t now_ns = monotonic_ns();
  policy.note(report, now_ns);
  if (report.outcome == CommandOutcome::kInterrupted) return;
  std::string text = fmt::format("controller {}: {}", command_.controller, report.text);
  if (report.outcome == CommandOutcome::kAlready) text += fmt::format(", but {}", kNoPackets);
  if (policy.has_given_up()) {
    text += "; asked in vain, and not again until packets come";
  } else if (!has_succeeded(report.outcome)) {
    text += fmt::format("; next attempt {:.0f} s later", policy.next_in_s(now_ns));
  }
  // An attempt that ends as the one before is no news, unless it was the last.
  if (report.text != logged_ || policy.has_given_up()) {
    const bool well = has_succeeded(report.outcome);
    spdlog::log(well ? spdlog::level::info : spdlog::level::warn, "tracker: {}", text);
  }
  logged_ = report.text;
  say(text);
}

void TrackerStarter::stop_tracking(const StartPolicy& policy) {
  if (!policy.ours()) return;
  dtrack::CommandOptions command = command_;
  command.timeout = kPartingTimeout;
  const dtrack::CommandReport report = dtrack::stop_tracking(command);
  if (has_succeeded(report.outcome)) {
    spdlog::info("tracker: controller {}: {}", command.controller, report.text);
  } else {
    spdlog::warn(
        "tracker: was started by this service, but could not be stopped: controller {}: {}",
        command.controller, report.text);
  }
}

void TrackerStarter::say(const std::string& text) {
  const std::scoped_lock lock(mutex_);
  text_ = text;
  told_ns_ = monotonic_ns();
}

std::string TrackerStarter::text() const {
  const std::scoped_lock lock(mutex_);
  return last_packet_ns_() > told_ns_ ? "" : text_;
}

}  // namespace handeye
