// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <optional>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

#include "client/cli/commands.hpp"
#include "client/cli/interrupt.hpp"
#include "client/cli/options.hpp"
#include "client/cli/recorder.hpp"
#include "client/cli/status_text.hpp"

namespace handeye::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kRenewalPeriod{5};
constexpr double kAskedDuration_s = 12;  ///< outlives a renewal that gets lost
constexpr seconds kPatience{3};

struct RecordOptions {
  ClientOptions client;
  OutputOptions output;
  std::filesystem::path recording;
  std::string camera_file;
  double duration_s{0};  ///< 0: until Ctrl-C
};

/// Keeps asking the daemon to publish what is to be recorded.
class RecordRequests {
 public:
  explicit RecordRequests(const ClientOptions& options) : client_(options) {}

  void spin() {
    if (Clock::now() >= due_) {
      client_.abandon(request_id_);
      request_id_ = client_.record(kAskedDuration_s);
      due_ = Clock::now() + kRenewalPeriod;
    }
    while (client_.spin_once(milliseconds(0))) {
    }
  }

  bool daemon_heard() const { return client_.last_status().has_value(); }

 private:
  Client client_;
  std::int64_t request_id_{0};
  Clock::time_point due_;
};

/// What to tell when a stream stays away; nothing while all is well.
std::optional<std::string> complaint(const Recorder& recorder, const RecordRequests& requests) {
  const bool frames = recorder.frames().received() > 0;
  const bool datagrams = recorder.datagrams().received() > 0;
  if (frames && datagrams) return std::nullopt;
  const std::string missing = frames      ? "datagrams of the tracker"
                              : datagrams ? "frames of the camera"
                                          : "frames or datagrams";
  return fmt::format("no {} yet: {}", missing,
                     requests.daemon_heard()
                         ? "look at 'handeye status' for what the device lacks"
                         : "no daemon is heard; is handeyed running, with the same LCM URL and "
                           "prefix?");
}

void record_until_the_end(Recorder& recorder, RecordRequests& requests, const Bus& bus,
                          Interrupt& interrupt, const RecordOptions& options) {
  ProgressLine progress;
  bool complained = false;
  const auto began = Clock::now();
  const std::chrono::duration<double> longest(options.duration_s);
  while (!interrupt.wait(bus.file_descriptor(), milliseconds(50))) {
    requests.spin();
    while (recorder.spin_once()) {
    }
    const auto elapsed = Clock::now() - began;
    if (options.duration_s > 0 && elapsed > longest) return;
    if (!complained && elapsed > kPatience) {
      complained = true;
      if (const auto text = complaint(recorder, requests)) {
        progress.clear();
        print_error(*text);
      }
    }
    progress.show(fmt::format("recording {:.0f} s: {}  (Ctrl-C ends)",
                              std::chrono::duration<double>(elapsed).count(), recorder.summary()));
  }
}

ExitCode run_record(const RecordOptions& options) {
  std::optional<CameraModel> camera;
  if (!options.camera_file.empty()) camera = read_camera_model(options.camera_file);
  Interrupt interrupt;
  Bus bus(options.client.lcm_url);
  RecordRequests requests(options.client);
  Recorder recorder(bus, Channels(options.client.channel_prefix), options.recording, camera);
  record_until_the_end(recorder, requests, bus, interrupt, options);
  recorder.close();
  if (options.output.json) {
    print_line(dump_json({{"recording", options.recording.string()},
                          {"frames", recorder.frames().received()},
                          {"frames_lost", recorder.frames().lost()},
                          {"frames_unusable", recorder.unusable_frames()},
                          {"datagrams", recorder.datagrams().received()},
                          {"datagrams_lost", recorder.datagrams().lost()}}));
  } else {
    print_line(fmt::format("{}: {}", options.recording.string(), recorder.summary()));
  }
  if (recorder.frames().received() + recorder.datagrams().received() == 0) {
    throw InputError("nothing was received, the recording is empty: see 'handeye status'");
  }
  return ExitCode::kOk;
}

}  // namespace

void add_record_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command = app.add_subcommand(
      "record", "record camera frames and tracker datagrams of the daemon, until Ctrl-C");
  command->add_option("recording", options->recording, "OUT.lcm: LCM log; else: a new folder")
      ->required()
      ->type_name("OUT");
  command->add_option("--duration", options->duration_s, "end by itself after this long")
      ->check(CLI::Range(0.1, 86400.0))
      ->type_name("S");
  command->add_option("--camera", options->camera_file, "intrinsics to put beside the recording")
      ->type_name("FILE");
  add_output_options(*command, options->output);
  add_client_options(*command, options->client);
  command->footer("Exit code: 0 recorded, 2 nothing received or not writable.");
  command->callback([options, &action] { action = [options] { return run_record(*options); }; });
}

}  // namespace handeye::cli
