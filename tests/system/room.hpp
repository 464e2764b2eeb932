// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/system/listener.hpp"
#include "tests/system/process.hpp"
#include "tests/system/reserved_port.hpp"

namespace handeye::test {

struct SimulatorSettings {
  std::uint64_t seed{1};
  std::string motion{"free"};
  double camera_rate_hz{20};
  std::string board;                     ///< the scene; empty: tissue
  std::vector<std::string> extra_words;  ///< of the command line
};

/// What the daemon's configuration may differ in; it is written beside camera.json.
struct DaemonSettings {
  std::optional<int> tracker_port;  ///< nothing: the room's own
  std::string intrinsics{"camera.json"};
  std::string extra_lines;  ///< appended to the file
};

/// An operating room of its own: folder, tracker port and LCM multicast port are nobody else's, so
/// several can exist at a time. Simulator and daemon are real processes and end with it.
class Room {
 public:
  Room();

  /// Starts the simulator and waits until it has written camera.json and truth.json.
  testing::AssertionResult start_simulator(const SimulatorSettings& settings = {});
  /// Kills tracker and camera, as when the plug is pulled.
  void kill_simulator() { simulator_.reset(); }

  /// Writes intrinsics without a simulator.
  void write_camera_file(const std::string& json) const;
  void write_config(const DaemonSettings& settings = {}) const;

  /// Writes the configuration, starts the daemon, waits for STATUS.
  testing::AssertionResult start_daemon(const DaemonSettings& settings = {});
  Process& daemon() { return *daemon_; }
  const Process& simulator() const { return *simulator_; }
  /// Sends SIGTERM and waits; nothing when it has not ended after `timeout`.
  std::optional<Finished> stop_daemon(std::chrono::milliseconds timeout);

  /// `handeye COMMAND --lcm-url ... ARGUMENTS...` for this room's daemon.
  std::vector<std::string> client_words(const std::string& command,
                                        const std::vector<std::string>& arguments = {}) const;

  Listener& listener() { return *listener_; }
  const std::string& lcm_url() const { return lcm_url_; }
  int tracker_port() const { return tracker_port_.number(); }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

 private:
  TemporaryFolder folder_;
  ReservedPort tracker_port_;
  ReservedPort lcm_port_;
  std::string lcm_url_;
  std::unique_ptr<Listener> listener_;
  std::unique_ptr<Process> simulator_;
  std::unique_ptr<Process> daemon_;
};

/// Tests with rooms; skipped where there is no multicast, which LCM needs.
class RoomTest : public testing::Test {
 protected:
  void SetUp() override;
};

/// Intrinsics that fit nothing in particular, 640x480.
inline constexpr const char* kSomeCamera =
    R"({"width":640,"height":480,"fx":500,"fy":500,"cx":320,"cy":240,"distortion":[0,0,0,0,0]})";

}  // namespace handeye::test
