// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include <CLI/Option.hpp>

#include "client/cli/commands.hpp"
#include "client/cli/options.hpp"
#include "client/cli/status_text.hpp"

namespace handeye::cli {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPatience{3000};

struct CancelOptions {
  ClientOptions client;
  OutputOptions output;
};

ExitCode run_cancel(const CancelOptions& options) {
  Client client(options.client);
  const std::int64_t id = client.cancel();
  const auto deadline = Clock::now() + kPatience;
  while (!client.acknowledgement(id) && Clock::now() < deadline) {
    client.spin_once(milliseconds(50));
  }
  const auto answer = client.acknowledgement(id);
  if (!answer) {
    throw InputError(client.last_status()
                         ? "STATUS is heard, but the daemon did not acknowledge the request"
                         : no_status_text(client, options.client));
  }
  const bool was_running = answer->taken();
  const std::string text = was_running ? "the running calibration was cancelled" : answer->text;
  print_line(options.output.json ? dump_json({{"cancelled", was_running}, {"text", text}})
                                 : printable(text));
  return ExitCode::kOk;
}

}  // namespace

void add_cancel_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CancelOptions>();
  CLI::App* command =
      app.add_subcommand("cancel", "cancel the running calibration, whoever started it");
  add_output_options(*command, options->output);
  add_client_options(*command, options->client);
  command->footer("Exit code: 0 nothing runs any more, 2 no daemon heard.");
  command->callback([options, &action] { action = [options] { return run_cancel(*options); }; });
}

}  // namespace handeye::cli
