// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <ctime>
#include <exception>
#include <optional>

#include <fmt/format.h>

#include "drivers/recording/recording.hpp"
#include "drivers/simulator/command_line.hpp"
#include "drivers/simulator/live.hpp"
#include "drivers/simulator/record.hpp"
#include "drivers/simulator/truth_file.hpp"
#include "protocol/bus.hpp"
#include "protocol/exit_codes.hpp"

namespace {

using namespace handeye;
using namespace handeye::simulator;

/// From the drawing of the world to its first event: time to open the connections.
constexpr std::int64_t kLeadNs = 500'000'000;

/// A recording has no host; its clock starts at a round number, the same every time.
constexpr std::int64_t kRecordingStartNs = 1'000'000'000'000;

/// SIGINT and SIGTERM, kept from killing and asked for instead.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    sigprocmask(SIG_BLOCK, &signals_, nullptr);
  }

  bool arrived() const {
    constexpr timespec kNoWait{0, 0};
    return sigtimedwait(&signals_, nullptr, &kNoWait) > 0;
  }

 private:
  sigset_t signals_{};
};

void write_extra_files(const CommandLine& line, const World& world) {
  if (line.camera_out) write_camera_model(*line.camera_out, world.camera);
  if (line.truth_out) write_truth(*line.truth_out, world);
}

DeviceCounts run(const CommandLine& line) {
  const StopSignals stop_signals;  // before any thread, which then inherits the mask
  std::optional<Controller> controller;
  LiveOptions live = line.live;
  if (line.controller) {
    controller.emplace(*line.controller);
    live.tracking = [&controller] { return controller->tracking(); };
    fmt::print(stderr, "handeye-sim: controller on TCP port {}, tracking is off\n",
               controller->port());
  }
  World world(line.simulator, 0);
  world.start_ns = monotonic_ns() + kLeadNs;
  write_extra_files(line, world);
  return run_live(world, line.duration_s, live, [&] { return stop_signals.arrived(); });
}

DeviceCounts record(const CommandLine& line) {
  const World world(line.simulator, kRecordingStartNs);
  const DeviceCounts counts = record(world, line.duration_s, line.recording);
  write_extra_files(line, world);
  return counts;
}

int simulate(int argc, char** argv) {
  const auto line = parse_command_line(argc, argv);
  if (!line) return static_cast<int>(ExitCode::kOk);
  const SimulatorOptions& options = line->simulator;
  fmt::print(stderr,
             "handeye-sim: seed {}, motion {}, disturbances {}, of tracker {}, of camera {}\n",
             options.seed, motion_name(options.motion), describe(options.disturbances),
             spelling(options.tracker_faults), spelling(options.camera_faults));
  const DeviceCounts counts =
      line->command == CommandLine::Command::kRun ? run(*line) : record(*line);
  fmt::print(stderr, "handeye-sim: {} frames ({} skipped), {} datagrams {}\n", counts.frames,
             counts.frames_skipped, counts.datagrams,
             line->command == CommandLine::Command::kRun ? "sent" : "recorded");
  return static_cast<int>(ExitCode::kOk);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return simulate(argc, argv);
  } catch (const UsageError& error) {
    fmt::print(stderr, "handeye-sim: {}\n", error.what());
    return static_cast<int>(ExitCode::kUsage);
  } catch (const std::exception& error) {
    fmt::print(stderr, "handeye-sim: {}\n", error.what());
    return static_cast<int>(ExitCode::kInput);
  }
}
