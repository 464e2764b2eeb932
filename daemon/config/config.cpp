// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/config.hpp"

#include <arpa/inet.h>
#include <array>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "daemon/config/section.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (std::filesystem::is_directory(path) || !file || !(text << file.rdbuf())) {
    // An empty file is a valid configuration, but operator<< fails on it.
    if (file && std::filesystem::is_regular_file(path) && std::filesystem::file_size(path) == 0) {
      return {};
    }
    throw InputError(fmt::format("{}: cannot read the configuration file", path.string()));
  }
  return text.str();
}

toml::table parse(const std::filesystem::path& path) {
  try {
    return toml::parse(read_file(path), path.string());
  } catch (const toml::parse_error& error) {
    throw UsageError(
        fmt::format("{}:{}: {}", path.string(), error.source().begin.line, error.description()));
  }
}

bool is_ipv4_address(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

void read_address(Section& section, std::string_view key, std::string& value) {
  section.read(key, value);
  if (!value.empty() && !is_ipv4_address(value)) {
    section.fail(key, "must be an IPv4 address like \"192.168.1.10\", or empty");
  }
}

/// Reads a text that must be one of a few words; returns its index.
template <std::size_t N>
std::size_t read_choice(Section& section, std::string_view key, std::string& value,
                        const std::array<std::string_view, N>& choices) {
  section.read(key, value);
  for (std::size_t i = 0; i < N; ++i) {
    if (value == choices[i]) return i;
  }
  section.fail(key, fmt::format("must be one of {}", fmt::join(choices, ", ")));
}

void read_path(Section& section, std::string_view key, const std::filesystem::path& directory,
               std::filesystem::path& value) {
  std::string text;
  section.read(key, text);
  // Relative to the configuration file, wherever the daemon is started.
  if (!text.empty()) value = directory / text;
}

void read_lcm(Section section, Config::Lcm& lcm) {
  section.read("url", lcm.url);
  section.read("prefix", lcm.prefix);
  if (!is_valid_channel_prefix(lcm.prefix)) {
    section.fail("prefix", "must be at most 40 letters, digits, '_' or '-'");
  }
  section.reject_unknown_keys();
}

/// The controller, and whether it is ever asked for anything.
void read_controller(Section& section, Config::Tracker& tracker) {
  read_address(section, "controller", tracker.controller);
  int port = tracker.command_port;
  section.read("command_port", port, 1, 65535);
  tracker.command_port = static_cast<std::uint16_t>(port);
  section.read("start_tracking", tracker.start_tracking);
  if (tracker.start_tracking && tracker.controller.empty()) {
    section.fail("start_tracking", "needs the controller's address: set controller, too");
  }
}

/// Whose word on the tracker's noise is taken.
void read_noise(Section& section, Config::Tracker& tracker) {
  constexpr std::array sources{HandNoiseSource::kMeasured, HandNoiseSource::kEstimated,
                               HandNoiseSource::kGiven};
  std::string word = "measured";
  tracker.noise = sources.at(
      read_choice(section, "noise", word,
                  std::array<std::string_view, sources.size()>{"measured", "estimated", "given"}));
  section.read("noise_rotation_deg", tracker.noise_rotation_deg, 1e-6, 10);
  section.read("noise_translation_mm", tracker.noise_translation_mm, 1e-6, 100);
}

void read_tracker(Section section, Config::Tracker& tracker) {
  int port = tracker.port;
  section.read("port", port, 0, 65535);
  tracker.port = static_cast<std::uint16_t>(port);
  read_address(section, "bind_address", tracker.bind_address);
  section.read("interface", tracker.interface);
  read_address(section, "multicast_group", tracker.multicast_group);
  read_controller(section, tracker);
  section.read("body_id", tracker.body_id, 0, 999);
  read_noise(section, tracker);
  section.reject_unknown_keys();
}

/// What is done about the lens, and whether enough is known for it.
void read_intrinsics_mode(Section& section, Config::Camera& camera) {
  std::string word(intrinsics_word(camera.intrinsics_mode));
  read_choice(section, "intrinsics_mode", word,
              std::array<std::string_view, 3>{"fixed", "refine", "estimate"});
  camera.intrinsics_mode = *intrinsics_from_word(word);
  if (!camera.intrinsics.empty()) return;
  if (camera.intrinsics_mode != IntrinsicsMode::kEstimate) {
    section.fail("intrinsics",
                 "is missing: name the camera.json of this camera, or have the lens found with "
                 "intrinsics_mode = \"estimate\"");
  }
  if (camera.width == 0) section.fail("width", "is needed where no intrinsics are given");
  if (camera.height == 0) section.fail("height", "is needed where no intrinsics are given");
}

void read_camera(Section section, const std::filesystem::path& directory, Config::Camera& camera) {
  std::string driver = "v4l2";
  const auto choice =
      read_choice(section, "driver", driver, std::array<std::string_view, 2>{"v4l2", "lcm"});
  camera.driver = choice == 0 ? Config::Camera::Driver::kV4l2 : Config::Camera::Driver::kLcm;
  section.read("device", camera.device);
  section.read("width", camera.width, 0, 16384);
  section.read("height", camera.height, 0, 16384);
  section.read("rate_hz", camera.rate_hz, 0, 1000);
  section.read("exposure_ms", camera.exposure_ms, 0, 1000);
  read_path(section, "intrinsics", directory, camera.intrinsics);
  read_path(section, "mask", directory, camera.mask);
  read_intrinsics_mode(section, camera);
  section.reject_unknown_keys();
}

void read_calibration(Section section, const std::filesystem::path& directory,
                      Config::Calibration& calibration) {
  section.read("sigma_rotation_deg", calibration.wanted.rotation_deg, 1e-4, 90);
  section.read("sigma_translation_mm", calibration.wanted.translation_mm, 1e-4, 1000);
  section.read("min_duration_s", calibration.min_duration_s, 0, 600);
  section.read("max_duration_s", calibration.max_duration_s, 1, 600);
  if (calibration.min_duration_s > calibration.max_duration_s) {
    section.fail("min_duration_s", "must not be above max_duration_s");
  }
  section.read("keep", calibration.keep);
  read_path(section, "store", directory, calibration.store);
  section.reject_unknown_keys();
}

void read_camera_pose(Section section, Config::CameraPose& camera_pose) {
  section.read("wait_ms", camera_pose.wait_ms, 0, 150);
  section.read("predict_ms", camera_pose.predict_ms, 0, 200);
  section.reject_unknown_keys();
}

void read_service(Section section, Config::Service& service) {
  section.read("realtime_priority", service.realtime_priority, 0, 99);
  section.read("stuck_after_s", service.stuck_after_s, 0.5, 3600);
  section.read("solver_stuck_after_s", service.solver_stuck_after_s, 0.5, 3600);
  section.reject_unknown_keys();
}

void read_log(Section section, Config::Log& log) {
  read_choice(section, "level", log.level,
              std::array<std::string_view, 4>{"debug", "info", "warning", "error"});
  section.reject_unknown_keys();
}

void reject_unknown_sections(const toml::table& root, const std::string& file) {
  const std::set<std::string, std::less<>> known{"lcm",         "tracker", "camera", "calibration",
                                                 "camera_pose", "service", "log"};
  for (const auto& [key, node] : root) {
    if (known.contains(key.str())) continue;
    const std::string meant = nearest_word(key.str(), known);
    throw UsageError(fmt::format("{}:{}: [{}] is not a section{}", file, node.source().begin.line,
                                 key.str(),
                                 meant.empty() ? "" : fmt::format("; did you mean [{}]?", meant)));
  }
}

}  // namespace

Config load_config(const std::filesystem::path& path) {
  const toml::table root = parse(path);
  const std::string file = path.string();
  reject_unknown_sections(root, file);
  Config config;
  read_lcm(Section(root, "lcm", file), config.lcm);
  read_tracker(Section(root, "tracker", file), config.tracker);
  read_camera(Section(root, "camera", file), path.parent_path(), config.camera);
  read_calibration(Section(root, "calibration", file), path.parent_path(), config.calibration);
  read_camera_pose(Section(root, "camera_pose", file), config.camera_pose);
  read_service(Section(root, "service", file), config.service);
  read_log(Section(root, "log", file), config.log);
  return config;
}

}  // namespace handeye
