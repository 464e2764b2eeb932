// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/room.hpp"

#include <csignal>
#include <thread>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// Far more than it takes: a machine may be busy with other things.
constexpr seconds kStartTimeout{30};

bool ends_with_brace(const std::filesystem::path& file) {
  const std::string text = read_bytes(file);
  return text.find_last_of('}') != std::string::npos;
}

}  // namespace

Room::Room()
    : lcm_url_(
          fmt::format("udpm://239.255.76.67:{}?ttl=0&recv_buf_size=4194304", lcm_port_.number())),
      listener_(std::make_unique<Listener>(lcm_url_)) {}

testing::AssertionResult Room::start_simulator(const SimulatorSettings& settings) {
  for (const char* file : {"camera.json", "truth.json"}) std::filesystem::remove(path(file));
  std::vector<std::string> words{handeye_sim(),    "run",
                                 "--seed",         std::to_string(settings.seed),
                                 "--motion",       settings.motion,
                                 "--rate",         fmt::format("{}", settings.camera_rate_hz),
                                 "--tracker-port", std::to_string(tracker_port()),
                                 "--lcm-url",      lcm_url_,
                                 "--camera-out",   path("camera.json"),
                                 "--truth-out",    path("truth.json")};
  if (!settings.board.empty()) words.insert(words.end(), {"--board", settings.board});
  words.insert(words.end(), settings.extra_words.begin(), settings.extra_words.end());
  simulator_ = std::make_unique<Process>(words);
  const auto deadline = steady_clock::now() + kStartTimeout;
  while (!ends_with_brace(path("camera.json")) || !ends_with_brace(path("truth.json"))) {
    if (simulator_->has_ended() || steady_clock::now() > deadline) {
      return testing::AssertionFailure() << "the simulator did not start: " << simulator_->err();
    }
    std::this_thread::sleep_for(milliseconds(10));
  }
  return testing::AssertionSuccess();
}

void Room::write_camera_file(const std::string& json) const {
  write_bytes(path("camera.json"), json);
}

void Room::write_config(const DaemonSettings& settings) const {
  write_bytes(path("handeyed.toml"),
              fmt::format("[lcm]\nurl = \"{}\"\n\n[tracker]\nport = {}\n\n[camera]\ndriver = "
                          "\"lcm\"\nintrinsics = \"{}\"\n{}",
                          lcm_url_, settings.tracker_port.value_or(tracker_port()),
                          settings.intrinsics, settings.extra_lines));
}

testing::AssertionResult Room::start_daemon(const DaemonSettings& settings) {
  write_config(settings);
  daemon_ = std::make_unique<Process>(
      std::vector<std::string>{handeyed(), "--config", path("handeyed.toml")});
  const std::size_t heard_before = listener_->statuses().size();
  const bool heard = listener_->spin_until(
      [&] { return listener_->statuses().size() > heard_before || daemon_->has_ended(); },
      kStartTimeout);
  if (heard && !daemon_->has_ended()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "the daemon did not start: " << daemon_->err();
}

std::optional<Finished> Room::stop_daemon(milliseconds timeout) {
  daemon_->send_signal(SIGTERM);
  return daemon_->wait(timeout);
}

std::vector<std::string> Room::client_words(const std::string& command,
                                            const std::vector<std::string>& arguments) const {
  std::vector<std::string> words{handeye(), command, "--lcm-url", lcm_url_};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

void RoomTest::SetUp() {
  try {
    const Bus bus{std::string(kDefaultLcmProvider)};
  } catch (const InputError& error) {
    GTEST_SKIP()
        << "programs talk to each other by LCM's multicast here, and it could not be opened "
           "at "
        << kDefaultLcmProvider << ": " << error.what();
  }
}

}  // namespace handeye::test
