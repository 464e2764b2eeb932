// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>

#include "client/cli/commands.hpp"
#include "client/cli/options.hpp"
#include "client/cli/status_text.hpp"

namespace handeye::cli {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPatience{2000};  ///< STATUS comes five times a second, always

struct StatusOptions {
  ClientOptions client;
  OutputOptions output;
};

ExitCode run_status(const StatusOptions& options) {
  Client client(options.client);
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!client.last_status() && std::chrono::steady_clock::now() < deadline) {
    client.spin_once(milliseconds(50));
  }
  const auto& status = client.last_status();
  if (!status) throw InputError(no_status_text(client, options.client));
  if (options.output.json) {
    print_line(dump_json(status_json(*status)));
  } else {
    std::fputs(status_text(*status, options.output.palette()).c_str(), stdout);
  }
  return ExitCode::kOk;
}

}  // namespace

void add_status_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* command = app.add_subcommand("status", "print the daemon's state once");
  add_output_options(*command, options->output);
  add_client_options(*command, options->client);
  command->footer("Exit code: 0 heard, 2 no daemon heard within two seconds.");
  command->callback([options, &action] { action = [options] { return run_status(*options); }; });
}

}  // namespace handeye::cli
