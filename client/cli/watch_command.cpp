// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <unistd.h>

#include "client/cli/commands.hpp"
#include "client/cli/interrupt.hpp"
#include "client/cli/options.hpp"
#include "client/cli/status_text.hpp"

namespace handeye::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPatience{2000};
constexpr std::string_view kHomeAndErase = "\033[H\033[J";

struct WatchOptions {
  ClientOptions client;
  OutputOptions output;
};

std::string one_view(const status_t& status, const WatchOptions& options) {
  if (options.output.json) return dump_json(status_json(status), -1);
  std::string text = status_text(status, options.output.palette());
  if (isatty(STDOUT_FILENO) == 1) text.insert(0, kHomeAndErase);
  return text;
}

/// Until Ctrl-C, or until the reader of a pipe has gone.
ExitCode run_watch(const WatchOptions& options) {
  Interrupt interrupt;
  Client client(options.client);
  bool readable = true;
  Clock::time_point last_heard = Clock::now();
  bool complained = false;
  client.on_status([&](const status_t& status) {
    last_heard = Clock::now();
    complained = false;
    readable = print_line(one_view(status, options));
  });
  while (readable && !interrupt.wait(client.file_descriptor(), milliseconds(100))) {
    while (readable && client.spin_once(milliseconds(0))) {
    }
    if (!complained && Clock::now() - last_heard > kPatience) {
      complained = true;
      print_error(no_status_text(client, options.client));
    }
  }
  return ExitCode::kOk;
}

}  // namespace

void add_watch_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<WatchOptions>();
  CLI::App* command = app.add_subcommand("watch", "show the daemon's state live, until Ctrl-C");
  add_output_options(*command, options->output);
  add_client_options(*command, options->client);
  command->footer("With --json: one document a line, for every STATUS.");
  command->callback([options, &action] { action = [options] { return run_watch(*options); }; });
}

}  // namespace handeye::cli
