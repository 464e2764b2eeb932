// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <handeye/camera_pose_t.hpp>

#include "client/cli/commands.hpp"
#include "client/cli/interrupt.hpp"
#include "client/cli/options.hpp"
#include "client/cli/status_text.hpp"
#include "daemon/geometry/pose.hpp"
#include "protocol/bus.hpp"

namespace handeye::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPatience{2000};

struct PoseOptions {
  ClientOptions client;
  OutputOptions output;
  std::int64_t count{0};   ///< 0: no end
  bool valid_only{false};  ///< leave out what must not be used
};

std::string_view validity_word(std::int32_t validity) {
  switch (validity) {
    case camera_pose_t::VALID:
      return "valid";
    case camera_pose_t::TRACKER_HIDDEN:
      return "tracker_hidden";
    case camera_pose_t::TRACKER_GAP:
      return "tracker_gap";
    case camera_pose_t::TRACKER_LATE:
      return "tracker_late";
    case camera_pose_t::TRACKER_SILENT:
      return "tracker_silent";
    default:
      return "unknown";
  }
}

std::vector<std::string_view> flag_words(std::int32_t flags) {
  std::vector<std::string_view> words;
  if ((flags & camera_pose_t::FLAG_PREDICTED) != 0) words.emplace_back("predicted");
  if ((flags & camera_pose_t::FLAG_CALIBRATION_DOUBTFUL) != 0) {
    words.emplace_back("calibration_doubtful");
  }
  if ((flags & camera_pose_t::FLAG_CALIBRATION_BROKEN) != 0) {
    words.emplace_back("calibration_broken");
  }
  if ((flags & camera_pose_t::FLAG_RESTORED) != 0) words.emplace_back("restored");
  return words;
}

std::string pose_json_line(const camera_pose_t& pose) {
  const bool valid = pose.validity == camera_pose_t::VALID;
  nlohmann::ordered_json json{{"session_id", pose.session_id},
                              {"seq", pose.seq},
                              {"timestamp_ns", pose.timestamp_ns},
                              {"frame_seq", pose.frame_seq},
                              {"validity", validity_word(pose.validity)},
                              {"flags", flag_words(pose.flags)},
                              {"predicted_s", pose.predicted_s},
                              {"room_from_eye", nullptr},
                              {"covariance", nullptr},
                              {"calibration_request_id", pose.calibration_request_id},
                              {"calibration_age_s", nullptr}};
  if (pose.calibration_age_s >= 0) json["calibration_age_s"] = pose.calibration_age_s;
  if (valid) {
    json["room_from_eye"] = {{"q_wxyz", pose.q_wxyz}, {"t_mm", pose.t_mm}};
    for (int row = 0; row < 6; ++row) {
      json["covariance"].push_back(
          std::vector<double>(pose.covariance + 6 * row, pose.covariance + 6 * (row + 1)));
    }
  }
  return dump_json(json, -1);
}

/// What a person reads of the covariance: square roots of the traces of its blocks, "deg mm".
std::string sigma_text(const camera_pose_t& pose) {
  const auto trace = [&](int first) {
    double sum = 0;
    for (int axis = first; axis < first + 3; ++axis) sum += pose.covariance[7 * axis];
    return sum;
  };
  return fmt::format("{:.3f} {:.3f}", deg_from_rad(std::sqrt(trace(0))), std::sqrt(trace(3)));
}

constexpr std::string_view kHead =
    "# timestamp_ns validity qw qx qy qz x_mm y_mm z_mm sigma_deg sigma_mm predicted_ms flags\n"
    "# room_from_eye; anything but 'valid' is all zero, do not use it; flags: predicted, "
    "calibration_doubtful, calibration_broken, restored, or -";

std::string pose_line(const camera_pose_t& pose) {
  const auto& q = pose.q_wxyz;
  const auto& t = pose.t_mm;
  const auto flags = flag_words(pose.flags);
  return fmt::format("{} {} {:.9f} {:.9f} {:.9f} {:.9f} {:.4f} {:.4f} {:.4f} {} {:.1f} {}",
                     pose.timestamp_ns, validity_word(pose.validity), q[0], q[1], q[2], q[3], t[0],
                     t[1], t[2], sigma_text(pose), 1e3 * pose.predicted_s,
                     flags.empty() ? "-" : fmt::format("{}", fmt::join(flags, ",")));
}

/// Until Ctrl-C, the wanted number of poses, or until the reader of a pipe has gone.
ExitCode run_pose(const PoseOptions& options) {
  Interrupt interrupt;
  Bus bus(options.client.lcm_url);
  bool readable = true;
  std::int64_t printed = 0;
  bool daemon_heard = false;
  bool heard = false;
  const Channels channels(options.client.channel_prefix);
  bus.subscribe<status_t>(channels.status, [&](const status_t&) { daemon_heard = true; });
  bus.subscribe<camera_pose_t>(channels.camera_pose, [&](const camera_pose_t& pose) {
    if (options.count > 0 && printed == options.count) return;
    heard = true;
    if (options.valid_only && pose.validity != camera_pose_t::VALID) return;
    if (printed == 0 && !options.output.json) {
      print_line(std::string(kHead));
    }
    readable = print_line(options.output.json ? pose_json_line(pose) : pose_line(pose));
    ++printed;
  });
  const auto complain_at = Clock::now() + kPatience;
  bool complained = false;
  const auto wanted_more = [&] {
    return readable && (options.count == 0 || printed < options.count);
  };
  while (wanted_more() && !interrupt.wait(bus.file_descriptor(), milliseconds(100))) {
    while (wanted_more() && bus.handle(milliseconds(0))) {
    }
    if (!heard && !complained && Clock::now() > complain_at) {
      complained = true;
      print_error(daemon_heard
                      ? "the daemon is heard but publishes no CAMERA_POSE: calibrate first "
                        "(handeye calibrate), and check the camera (handeye status)"
                      : "no daemon is heard: see 'handeye status'");
    }
  }
  return ExitCode::kOk;
}

}  // namespace

void add_pose_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<PoseOptions>();
  CLI::App* command =
      app.add_subcommand("pose", "print the camera's pose in the room with every frame");
  command->add_option("--count", options->count, "stop after this many; default: at Ctrl-C")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40))
      ->type_name("N");
  command->add_flag("--valid-only", options->valid_only,
                    "leave out poses that must not be used: hidden, or too late");
  add_output_options(*command, options->output);
  add_client_options(*command, options->client);
  command->footer(
      "With --json: one document a line. Poses that are not 'valid' are all zero (null with "
      "--json). "
      "A pose flagged 'predicted' was carried beyond the tracker's last sample; "
      "'calibration_doubtful' and 'calibration_broken' say that the head seems to have been "
      "turned: "
      "calibrate again; 'restored' that the calibration is from before the daemon's last restart, "
      "and not seen to hold since.");
  command->callback([options, &action] { action = [options] { return run_pose(*options); }; });
}

}  // namespace handeye::cli
