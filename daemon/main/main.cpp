// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <handeye/version.hpp>
#include <opencv2/core.hpp>

#include "daemon/config/config.hpp"
#include "daemon/service/event_loop.hpp"
#include "daemon/service/journal.hpp"
#include "daemon/service/service.hpp"
#include "daemon/service/thread_role.hpp"
#include "protocol/exit_codes.hpp"

namespace {

using handeye::ExitCode;

struct CommandLine {
  std::string config_file{"/etc/handeyed/handeyed.toml"};
  bool check_config{false};
};

int run(const CommandLine& command_line) {
  const handeye::Config config = handeye::load_config(command_line.config_file);
  if (command_line.check_config) {
    handeye::read_camera_files(config.camera);
    fmt::print("{}: ok\n", command_line.config_file);
    return static_cast<int>(ExitCode::kOk);
  }
  handeye::set_up_logging(config.log.level);
  // Before any other thread starts, LCM's too: they inherit it.
  handeye::take_role({.name = "handeyed"});
  handeye::EventLoop::block_signals({SIGTERM, SIGINT});
  // The threads of the service are the parallelism; OpenCV's own would steal from the sockets.
  cv::setNumThreads(1);
  handeye::Service service(config);
  service.run();
  return static_cast<int>(ExitCode::kOk);
}

int fail(ExitCode code, const std::exception& error) {
  fmt::print(stderr, "handeyed: {}\n", error.what());
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine command_line;
  CLI::App app{"Hand-eye calibration service for tracked endoscopes", "handeyed"};
  app.set_version_flag("--version", std::string(handeye::kVersion));
  app.add_option("-c,--config", command_line.config_file, "Configuration file (TOML)")
      ->capture_default_str();
  app.add_flag("--check-config", command_line.check_config,
               "Check the configuration and the files it names, then exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help, version
    fmt::print(stderr, "handeyed: {} (see 'handeyed --help')\n", error.what());
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    return run(command_line);
  } catch (const handeye::UsageError& error) {
    return fail(ExitCode::kUsage, error);
  } catch (const handeye::InputError& error) {
    return fail(ExitCode::kInput, error);
  } catch (const std::exception& error) {
    return fail(ExitCode::kInput, error);
  }
}
